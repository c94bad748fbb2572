// The figures of what drove a run.
#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/system.hpp>

namespace hamel::figures {
namespace {

// The i-th input from t0 to t1 (t0 < t1) as it acts: a held table is a stair.
Curve drawn(const Inputs& inputs, size_t i, double t0, double t1) {
  const InputField& field = inputs.fields()[i];
  const InputTable& table = inputs.tables()[i];
  std::vector<double> t = {t0}, value;
  std::copy_if(table.times.begin(), table.times.end(), std::back_inserter(t),
               [&](double at) { return at > t0 && at < t1; });
  t.push_back(t1);
  if (!table.hold) {
    for (const double at : t) value.push_back(table.at(at));
  } else {
    std::vector<double> corners;
    for (size_t j = 0; j + 1 < t.size(); ++j) {
      corners.insert(corners.end(), {t[j], t[j + 1]});
      value.insert(value.end(), 2, table.at(t[j]));
    }
    t = std::move(corners);
  }
  return in_unit(thinned(field.name, t, value, false), field.unit);
}

}  // namespace

void add_inputs(std::vector<Figure>& out, const Result& r, const std::vector<Mark>& marks) {
  if (r.inputs == nullptr) return;
  const std::vector<InputField>& fields = r.inputs->fields();
  const std::vector<InputTable>& tables = r.inputs->tables();
  if (std::all_of(tables.begin(), tables.end(), [](const auto& t) { return t.times.empty(); }))
    return;
  const auto [t0, t1] = std::minmax(r.config.from, r.last.time);
  std::map<std::string, std::vector<Curve>> by_unit;
  for (size_t i = 0; i < fields.size(); ++i)
    if (r.config.inputs.contains(fields[i].name))
      by_unit[fields[i].unit].push_back(drawn(*r.inputs, i, t0, t1));
  for (auto& [unit, curves] : by_unit)
    out.push_back(over_time("Inputs", {"", unit}, std::move(curves), "", "", marks));
}

}  // namespace hamel::figures
