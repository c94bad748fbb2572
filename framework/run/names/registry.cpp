#include <hamel/framework/run/names/registry.hpp>

#include <algorithm>
#include <charconv>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/loop/scaled_equation.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {
namespace {

template <class Map>
auto find(const Map& map, const typename Map::key_type& key) -> const typename Map::mapped_type* {
  const auto it = map.find(key);
  return it == map.end() ? nullptr : &it->second;
}

template <class Map>
std::vector<std::string> names(const Map& map) {
  std::vector<std::string> out;
  for (const auto& entry : map) out.push_back(entry.first);
  return out;
}

std::string kernel_key(const std::string& problem, const std::string& retraction,
                       const std::string& scheme) {
  return fmt::format("{}/{}/{}", problem, retraction, scheme);
}

class FunctionSolver final : public Solver {
 public:
  explicit FunctionSolver(SolveFunction solve) : solve_(std::move(solve)) {}
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    equation_.start(equation, x, tolerance);
    solve_(equation_, x, equation_.target());
    const int evaluations = equation_.evaluations();
    return equation_.finish(x, evaluations);
  }

 private:
  ScaledEquation equation_;
  SolveFunction solve_;
};

}  // namespace

struct Registry::Deferred {
  std::function<SystemInfo()> make;
  std::once_flag made;
  SystemInfo info;
};

struct Registry::WithOptions {
  std::mutex one_at_a_time;
  std::map<std::string, SystemInfo> systems;
};

Registry::Registry() : with_options_(std::make_shared<WithOptions>()) {}

ClaimedOrder SchemeInfo::claim(double s, TauTraits tau, const Mechanics& system,
                               const std::string& force_at) const {
  const bool constant =
      system.constant_inertia() && system.constant_constraints() && !system.has_drift();
  const bool nodal = places_forces && force_at == "nodes";
  return claim(s, tau, system.left_invariant() || (nodal && constant));
}
ClaimedOrder SchemeInfo::claim(double s, TauTraits tau, bool left_invariant) const {
  if (!defined(left_invariant)) return {0, false};
  return claims(uses_s ? s : fixed_s, tau, left_invariant);
}

std::string problem_key(const std::string& group, int m) { return fmt::format("{}/{}", group, m); }
std::string problem_key(const std::type_info& mechanics) { return mechanics.name(); }

void Registry::add(GroupInfo info) { groups_[info.name] = std::move(info); }
void Registry::add(RetractionInfo info) { retractions_[{info.group, info.name}] = std::move(info); }
void Registry::add(SchemeInfo info) { schemes_[info.name] = std::move(info); }
void Registry::add(SolverInfo info) {
  absent_solvers_.erase(info.name);
  solvers_[info.name] = std::move(info);
}
void Registry::add_solver(const std::string& name, const std::string& summary,
                          SolveFunction solve) {
  add(SolverInfo{name, summary, "",
                 [solve = std::move(solve)] { return std::make_shared<FunctionSolver>(solve); }});
}
void Registry::add_absent(SolverInfo info) { absent_solvers_[info.name] = std::move(info); }
void Registry::add_scheme_alias(const std::string& alias, const std::string& scheme) {
  scheme_aliases_[alias] = scheme;
}
void Registry::add(SystemInfo info) {
  with_options_ = std::make_shared<WithOptions>();
  systems_[info.name] = std::move(info);
}
void Registry::add(FileKind kind) { file_kinds_.push_back(std::move(kind)); }
void Registry::add(FileFormat format) { file_formats_.push_back(std::move(format)); }
void Registry::add_deferred(const std::string& name, std::function<SystemInfo()> make) {
  const auto entry = std::make_shared<Deferred>();
  entry->make = std::move(make);
  deferred_[name] = entry;
}
void Registry::add_kernel(const std::string& problem, const std::string& retraction,
                          const std::string& scheme, KernelFactory factory) {
  kernels_[kernel_key(problem, retraction, scheme)] = std::move(factory);
}

void Registry::add_lanes(const std::string& problem, const std::string& retraction,
                         const std::string& scheme, LaneInfo info) {
  lanes_[kernel_key(problem, retraction, scheme)] = std::move(info);
}

const GroupInfo* Registry::group(const std::string& name) const { return find(groups_, name); }
const RetractionInfo* Registry::retraction(const std::string& group,
                                           const std::string& name) const {
  return find(retractions_, {group, name});
}
const SchemeInfo* Registry::scheme(const std::string& name) const {
  if (const SchemeInfo* info = find(schemes_, name)) return info;
  const std::string* target = find(scheme_aliases_, name);
  return target == nullptr ? nullptr : find(schemes_, *target);
}
const SolverInfo* Registry::solver(const std::string& name) const { return find(solvers_, name); }
const SolverInfo* Registry::absent_solver(const std::string& name) const {
  return find(absent_solvers_, name);
}
const SystemInfo* Registry::system(const std::string& name) const {
  if (const SystemInfo* info = find(systems_, name)) return info;
  const auto it = deferred_.find(name);
  if (it == deferred_.end()) return system_with_options(name);
  Deferred& entry = *it->second;
  std::call_once(entry.made, [&] { entry.info = entry.make(); });
  return &entry.info;
}

const SystemInfo* Registry::system_with_options(const std::string& name) const {
  const std::string own = path_of_system(name);
  const SystemInfo* info = own == name || names_file(name) ? nullptr : system(own);
  if (info == nullptr) return nullptr;
  const NameOptions options = options_of_system(name);
  for (const auto& [option, values] : options)
    if (!info->make_with || option != "hold")
      throw ConfigError({info->make_with
                             ? unknown_name("option of " + own, option, {"hold"})
                             : fmt::format("system: '{}' takes no options, got '{}'", own, name)});
  const std::lock_guard lock(with_options_->one_at_a_time);
  const auto [at, is_new] = with_options_->systems.try_emplace(name, *info);
  if (is_new)
    at->second.make = [make = info->make_with, options](const Parameters& given) {
      return make(given, options);
    };
  return &at->second;
}
namespace {
std::string problem_of(const std::string& group, const Mechanics& mechanics) {
  return mechanics.left_invariant()
             ? problem_key(group, mechanics.dim() - mechanics.constraint_count())
             : problem_key(typeid(mechanics));
}
}  // namespace

const KernelFactory* Registry::kernel(const std::string& group, const Mechanics& mechanics,
                                      const std::string& retraction,
                                      const std::string& scheme) const {
  return find(kernels_, kernel_key(problem_of(group, mechanics), retraction, scheme));
}
const LaneInfo* Registry::lanes(const std::string& group, const Mechanics& mechanics,
                                const std::string& retraction, const std::string& scheme) const {
  return find(lanes_, kernel_key(problem_of(group, mechanics), retraction, scheme));
}

namespace {

// "se2*so2^3" -> {"se2", "so2", "so2", "so2"}, no more than kMaxDimension + 1 of them; empty when
// it cannot be read.
std::vector<std::string> factors_of(const std::string& name) {
  std::vector<std::string> out;
  if (name.ends_with('*')) return out;
  std::istringstream in(name);
  for (std::string word; std::getline(in, word, '*');) {
    long count = 1;
    if (const size_t hat = word.find('^'); hat != std::string::npos) {
      const std::string power = word.substr(hat + 1);
      const auto [end, error] = std::from_chars(power.data(), power.data() + power.size(), count);
      if (error != std::errc() || end != power.data() + power.size() || count < 0) return {};
      word.resize(hat);
    }
    const auto room = static_cast<long>(kMaxDimension + 1 - out.size());
    out.insert(out.end(), static_cast<size_t>(std::min(count, room)), word);
  }
  return out;
}

const std::string kLine = "r1";

// n of the name "rn", "r12"; kMaxDimension + 1 where it is larger; 0 of other names.
int translations_in(const std::string& name) {
  if (name.size() < 2 || name[0] != 'r' || name[1] == '0') return 0;
  if (name.find_first_not_of("0123456789", 1) != std::string::npos) return 0;
  int n = kMaxDimension + 1;
  std::from_chars(name.data() + 1, name.data() + name.size(), n);
  return std::min(n, kMaxDimension + 1);
}

// R^n as n lines: a group of its own, with the columns x1, x2, ... and one homogeneous matrix.
GroupInfo translations(int n, const GroupInfo& line) {
  GroupInfo info =
      product_info(fmt::format("r{}", n), std::vector<GroupInfo>(static_cast<size_t>(n), line));
  GroupFactor whole = {.name = info.name, .dim = n, .columns = n, .is_shape = true};
  info.columns.clear();
  for (int i = 1; i <= n; ++i) {
    info.columns.push_back(fmt::format("x{}", i));
    whole.components.push_back({info.columns.back() + "'", "m/s"});
    whole.units.emplace_back("m");
  }
  whole.names = info.columns;
  whole.coordinate_rates = detail::copy_rates;
  whole.add_pulled_back = detail::add_slopes;
  info.factors = {whole};
  info.summary = line.summary;
  info.formula = line.formula;
  info.source = line.source;
  info.matrices = [n](std::span<const double> x) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n + 1, n + 1);
    m.topRightCorner(n, 1) = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
    return std::vector<PlainMatrix>{PlainMatrix(m)};
  };
  return info;
}

// A registered group, or translations by their dimension.
std::optional<GroupInfo> simple_group(const Registry& registry, const std::string& name) {
  if (const GroupInfo* info = registry.group(name)) return *info;
  const GroupInfo* line = registry.group(kLine);
  const int n = translations_in(name);
  if (line == nullptr || n == 0) return {};
  return translations(n, *line);
}

}  // namespace

std::optional<GroupInfo> Registry::group_or_product(const std::string& name) const {
  if (auto info = simple_group(*this, name); info && info->dim <= kMaxDimension) return info;
  std::vector<GroupInfo> factors;
  for (const std::string& word : factors_of(name)) {
    const auto info = simple_group(*this, word);
    if (!info) return {};
    factors.push_back(*info);
  }
  const int dim = std::accumulate(factors.begin(), factors.end(), 0,
                                  [](int sum, const GroupInfo& info) { return sum + info.dim; });
  if (factors.empty() || dim > kMaxDimension) return {};
  return product_info(name, factors);
}

bool Registry::complete(SystemModel& model) const {
  if (model.group.dim == 0) {
    const auto group = group_or_product(model.group.name);
    if (!group) return false;
    model.group = *group;
  }
  name_quantities(model);
  return true;
}

std::string Registry::missing_group(const std::string& name) const {
  const std::vector<std::string> factors = factors_of(name);
  const auto known = [&](const std::string& word) { return simple_group(*this, word).has_value(); };
  if (factors.empty() || !std::all_of(factors.begin(), factors.end(), known))
    return unknown_name("group", name, groups());
  return fmt::format("group '{}': its dimension is above {}", shortened(name), kMaxDimension);
}

std::shared_ptr<const Geometry> Registry::geometry(const std::string& group,
                                                   const std::string& retraction) const {
  if (const RetractionInfo* info = this->retraction(group, retraction)) return info->geometry;
  const std::vector<std::string> factors = factors_of(group);
  std::string elsewhere;
  for (const std::string& word : factors) {
    const RetractionInfo* info = this->retraction(word, retraction);
    if (info != nullptr && !info->elsewhere.empty()) elsewhere = info->elsewhere;
  }
  std::vector<std::shared_ptr<const Geometry>> parts;
  for (const std::string& word : factors) {
    const int lines = this->group(word) == nullptr ? translations_in(word) : 0;
    const std::string& simple = lines > 0 ? kLine : word;
    const RetractionInfo* info = this->retraction(simple, retraction);
    if (info == nullptr) info = this->retraction(simple, elsewhere);
    if (info == nullptr) return nullptr;
    parts.insert(parts.end(), static_cast<size_t>(std::max(lines, 1)), info->geometry);
  }
  if (parts.empty()) return nullptr;
  return std::make_shared<ProductGeometry>(parts);
}

std::vector<std::string> Registry::retractions_or_common(const std::string& group) const {
  std::vector<std::string> out = retractions(group);
  if (!out.empty()) return out;
  for (const std::string& name : retractions()) {
    if (geometry(group, name) != nullptr) out.push_back(name);
  }
  return out;
}

std::vector<std::string> Registry::groups() const { return names(groups_); }
std::vector<std::string> Registry::retractions() const {
  std::set<std::string> all;
  for (const auto& [key, info] : retractions_) all.insert(info.name);
  return {all.begin(), all.end()};
}
std::vector<std::string> Registry::retractions(const std::string& group) const {
  std::vector<std::string> out;
  for (const auto& [key, info] : retractions_) {
    if (key.first == group) out.push_back(key.second);
  }
  return out;
}
std::vector<std::string> Registry::schemes() const { return names(schemes_); }
std::vector<std::string> Registry::solvers() const { return names(solvers_); }
std::vector<std::string> Registry::absent_solvers() const { return names(absent_solvers_); }
std::string Registry::missing_solver(const std::string& name) const {
  if (const SolverInfo* info = absent_solver(name)) {
    return fmt::format("solver '{}' needs the package {}: install it and build again", name,
                       info->package);
  }
  return unknown_name("solver", name, solvers());
}
std::vector<std::string> Registry::systems() const { return names(systems_); }
std::vector<std::string> Registry::deferred_systems() const { return names(deferred_); }
std::vector<std::string> Registry::systems_and_files() const {
  std::vector<std::string> out = systems();
  for (std::string& name : deferred_systems()) out.push_back(std::move(name));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace hamel
