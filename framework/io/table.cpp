#include <hamel/framework/io/table.hpp>

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

// RFC 4180: quoted where it must be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

}  // namespace

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
  throw ConfigError({unknown_name("column", name, known)});
}

std::string Table::csv() const {
  std::string out;
  for (size_t j = 0; j < columns.size(); ++j) out += (j > 0 ? "," : "") + field(columns[j].name);
  out += '\n';
  for (size_t i = 0; i < rows(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) {
      if (j > 0) out += ',';
      out += field(columns[j].text(i));
    }
    out += '\n';
  }
  return out;
}

}  // namespace hamel
