#include <hamel/framework/io/table.hpp>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

#include <hamel/framework/io/csv_file.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>

namespace hamel {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}
size_t TableColumn::size() const {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

std::string TableColumn::text(size_t row) const {
  if (const auto* words = std::get_if<std::vector<std::string>>(&values)) return (*words)[row];
  if (const auto* whole = std::get_if<std::vector<long long>>(&values))
    return fmt::format("{}", (*whole)[row]);
  const double number = std::get<std::vector<double>>(values)[row];
  return std::isfinite(number) ? fmt::format("{}", number) : "";
}

const TableColumn& Table::column(const std::string& name) const {
  std::vector<std::string> known;
  for (const TableColumn& c : columns) {
    if (c.name == name) return c;
    known.push_back(c.name);
  }
  if (const auto other = other_names.find(name); other != other_names.end())
    return column(other->second);
  throw ConfigError({unknown_name("column", name, known)});
}

namespace {

// A number needs no quotes.
void append_field(const TableColumn& column, size_t row, std::string& out) {
  const auto* numbers = std::get_if<std::vector<double>>(&column.values);
  if (numbers == nullptr) out += csv_field(column.text(row));
  else if (std::isfinite((*numbers)[row]))
    fmt::format_to(std::back_inserter(out), "{}", (*numbers)[row]);
}

// The title and the rows, line by line; each line has its end.
template <class Put>
void lines_of(const Table& table, const std::string& numbered, Put&& put) {
  std::string out;
  const auto line = [&](const std::string& first, const auto& append) {
    out = first;
    for (size_t j = 0; j < table.columns.size(); ++j) {
      if (j > 0 || !numbered.empty()) out += ',';
      append(table.columns[j]);
    }
    put(out += '\n');
  };
  line(csv_field(numbered), [&](const TableColumn& column) { out += csv_field(column.name); });
  for (size_t i = 0; i < table.rows(); ++i)
    line(numbered.empty() ? "" : std::to_string(i),
         [&](const TableColumn& column) { append_field(column, i, out); });
}

}  // namespace

std::string Table::csv() const {
  std::string out;
  lines_of(*this, "", [&](const std::string& line) { out += line; });
  return out;
}

void write_csv(const Table& table, const std::string& path, const std::string& numbered) {
  const std::string part = part_of(path);
  std::FILE* file = std::fopen(part.c_str(), "w");
  bool good = file != nullptr;
  lines_of(table, numbered, [&](const std::string& line) {
    good = good && std::fwrite(line.data(), 1, line.size(), file) == line.size();
  });
  if (file != nullptr) good = std::fclose(file) == 0 && good;
  if (!good) {
    const int reason = errno;
    std::remove(part.c_str());
    throw Unfinished(fmt::format("output: cannot write '{}': {}", path, std::strerror(reason)));
  }
  finish_file(part, path);
}

}  // namespace hamel
