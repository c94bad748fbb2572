#include <hamel/framework/run/data_system.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/lie/differences.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {
namespace {

// V = sum weight x + 1/2 stiffness (x - rest)^2 over columns x of the element; f_i = -damping_i xi_i.
struct Terms {
  Eigen::VectorXd weight, stiffness, rest;  // a number for each column
  Eigen::VectorXd damping;                  // n
  explicit Terms(Eigen::Index columns = 0, Eigen::Index n = 0)
      : weight(Eigen::VectorXd::Zero(columns)),
        stiffness(weight),
        rest(weight),
        damping(Eigen::VectorXd::Zero(n)) {}
  bool potential() const { return (weight.array() != 0).any() || (stiffness.array() != 0).any(); }
};

class DataMechanics final : public Mechanics {
  struct Operations {  // for differentiate_along
    const Geometry& geometry;
    void tau(const Eigen::VectorXd& xi, Eigen::VectorXd& out) const {
      geometry.tau(xi.data(), out.data());
    }
    void compose(const double* g, const Eigen::VectorXd& h, Eigen::VectorXd& out) const {
      geometry.compose(g, h.data(), out.data());
    }
  };

 public:
  DataMechanics(Eigen::MatrixXd inertia, Eigen::MatrixXd a, Eigen::VectorXd b, Terms terms,
                std::shared_ptr<const Geometry> geometry)
      : inertia_(std::move(inertia)),
        a_(std::move(a)),
        b_(std::move(b)),
        terms_(std::move(terms)),
        geometry_(std::move(geometry)),
        columns_(geometry_->columns()),
        moved_(geometry_->size()),
        step_(dim()),
        axis_(dim()) {}
  int dim() const override { return static_cast<int>(inertia_.rows()); }
  int rows() const override { return static_cast<int>(a_.rows()); }
  bool constant_constraints() const override { return true; }
  bool has_force() const override { return !terms_.damping.isZero(0); }
  bool has_drift() const override { return !b_.isZero(0); }
  void inertia(const double* /*g*/, Matrix out) const override { out = inertia_; }
  void constraints(double /*t*/, const double* /*g*/, Matrix a, Vector b) const override {
    a = a_;
    b = b_;
  }
  double potential(const double* g) const override {
    geometry_->coordinates(g, columns_.data());
    const auto off = (columns_ - terms_.rest).array();
    return terms_.weight.dot(columns_) + 0.5 * (terms_.stiffness.array() * off * off).sum();
  }
  bool force_depends_on_velocity() const override { return !terms_.damping.isZero(0); }
  double power(double /*t*/, const double* /*g*/, ConstVector xi) const override {
    return -terms_.damping.dot(xi.cwiseAbs2());
  }
  void force(double /*t*/, const double* g, ConstVector xi, Vector out) const override {
    out = -terms_.damping.cwiseProduct(xi);
    if (!terms_.potential()) return;
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      axis_ = Eigen::VectorXd::Unit(dim(), i);
      differentiate_along(
          Operations{*geometry_}, g, axis_, step_, moved_,
          [&](double, double weight) { out[i] -= weight * potential(moved_.data()); });
    }
  }

 private:
  Eigen::MatrixXd inertia_, a_;
  Eigen::VectorXd b_;
  Terms terms_;
  std::shared_ptr<const Geometry> geometry_;
  mutable Eigen::VectorXd columns_, moved_, step_, axis_;
};

class File {
 public:
  File(const Registry& registry, const std::string& origin)
      : registry_(registry), origin_(origin), read_(origin) {}

  SystemModel read(const std::string& text) {
    const toml::table table = read_.parse(text);
    if (const toml::node* other = table.get("system")) {
      throw ConfigError({fmt::format(
          "{}: this file is {}, no system by data", origin_,
          other->is_array()
              ? fmt::format("a study (hamel study {})", origin_)
              : fmt::format("the configuration of a run (hamel run --config {})", origin_))});
    }
    SystemModel model;
    model.name = origin_;
    model.group = group_of(table);
    n_ = model.group.dim;
    terms_ = Terms(static_cast<Eigen::Index>(model.group.columns.size()), n_);
    Eigen::MatrixXd inertia = Eigen::MatrixXd::Identity(n_, n_), a(0, n_);
    if (const auto* node = table.get("constraints")) rows(*node, "constraints", a);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
    if (!table.contains("inertia")) {
      read_.mistakes.push_back(
          fmt::format("{}: inertia: missing, expected {} entries", origin_, n_));
    }
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      if (key == "name") read_.value(node, key, model.name);
      else if (key == "inertia") square(node, key, inertia);
      else if (key == "drift") b = numbers(node, key, a.rows());
      else if (key == "configuration")
        start(node, key, terms_.rest.size(), model.start.configuration);
      else if (key == "velocity") start(node, key, n_, model.start.velocity);
      else if (key == "momentum") start(node, key, n_, model.start.momentum);
      else if (key == "linear") linear(node, model.group);
      else if (key == "spring") springs(node, model.group);
      else if (key == "damping") damping(node);
      else if (key != "group" && key != "constraints") read_.unknown_key(node, key, keys());
    }
    if (!read_.mistakes.empty()) throw ConfigError(read_.mistakes);
    const bool invariant = !terms_.potential() && b.isZero(0) && terms_.damping.isZero(0);
    if (invariant) {
      model.mechanics = std::make_shared<LeftInvariantMechanics>(inertia, a);
    } else {
      model.mechanics = std::make_shared<DataMechanics>(
          inertia, a, b, terms_, registry_.geometry(model.group.name, "exp"));
    }
    return model;
  }

 private:
  static const std::vector<std::string>& keys() {
    static const std::vector<std::string> all = {
        "configuration", "constraints", "damping", "drift",  "group",   "inertia",
        "linear",        "momentum",    "name",    "spring", "velocity"};
    return all;
  }

  // All else depends on the group.
  GroupInfo group_of(const toml::table& table) {
    std::string name;
    const toml::node* node = table.get("group");
    if (node == nullptr) {
      read_.mistakes.push_back(
          fmt::format("{}: group: missing, expected the name of a group", origin_));
    } else {
      read_.value(*node, "group", name);
    }
    if (!read_.mistakes.empty()) throw ConfigError(read_.mistakes);
    const auto info = registry_.group_or_product(name);
    if (!info)
      read_.mistakes.push_back(
          fmt::format("{}: {}", read_.place(*node), registry_.missing_group(name)));
    else if (registry_.geometry(name, "exp") == nullptr)
      read_.wrong(*node, "group", "a group with the retraction exp");
    if (!read_.mistakes.empty()) throw ConfigError(read_.mistakes);
    return *info;
  }

  double number(const toml::node& node, const std::string& key) {
    double out = 0;
    if (const auto value = node.value<double>(); value && std::isfinite(*value)) out = *value;
    else read_.wrong(node, key, "a finite number");
    return out;
  }
  Eigen::VectorXd numbers(const toml::node& node, const std::string& key, Eigen::Index count) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(count);
    const toml::array* array = node.as_array();
    if (array == nullptr || static_cast<Eigen::Index>(array->size()) != count) {
      read_.wrong(node, key, fmt::format("{} numbers", count));
    } else {
      for (Eigen::Index i = 0; i < count; ++i)
        out[i] = number((*array)[static_cast<size_t>(i)], key);
    }
    return out;
  }
  void start(const toml::node& node, const std::string& key, Eigen::Index count,
             std::vector<double>& out) {
    const Eigen::VectorXd values = numbers(node, key, count);
    out.assign(values.begin(), values.end());
  }
  void rows(const toml::node& node, const std::string& key, Eigen::MatrixXd& out) {
    const toml::array* array = node.as_array();
    if (array == nullptr) {
      read_.wrong(node, key, fmt::format("rows of {} numbers", n_));
      return;
    }
    out.resize(static_cast<Eigen::Index>(array->size()), n_);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      out.row(i) = numbers((*array)[static_cast<size_t>(i)], key, n_).transpose();
    }
  }
  // n rows, or n numbers, the diagonal.
  void square(const toml::node& node, const std::string& key, Eigen::MatrixXd& out) {
    const toml::array* array = node.as_array();
    if (array == nullptr || static_cast<Eigen::Index>(array->size()) != n_) {
      read_.wrong(node, key, fmt::format("{} numbers or {} rows", n_, n_));
    } else if (array->front().is_array()) {
      rows(node, key, out);
    } else {
      out = numbers(node, key, n_).asDiagonal();
    }
  }

  // visit(name, full key, value) for each entry of a table.
  template <class Visit>
  void each(const toml::node& node, const std::string& key, const Visit& visit) {
    const toml::table* entries = node.as_table();
    if (entries == nullptr) {
      read_.wrong(node, key, "a table");
      return;
    }
    for (const auto& [name, value] : *entries) {
      const std::string word(name.str());
      visit(word, key + "." + word, value);
    }
  }
  // -1 for a name that the group does not have.
  Eigen::Index column(const toml::node& node, const GroupInfo& group, const std::string& name) {
    const auto it = std::find(group.columns.begin(), group.columns.end(), name);
    if (it != group.columns.end()) return it - group.columns.begin();
    read_.unknown(node, "column of " + group.name, name, group.columns);
    return -1;
  }
  void linear(const toml::node& table, const GroupInfo& group) {
    each(table, "linear", [&](const std::string& name, const std::string& key, const auto& node) {
      const Eigen::Index j = column(node, group, name);
      const double weight = number(node, key);
      if (j >= 0) terms_.weight[j] = weight;
    });
  }
  void springs(const toml::node& table, const GroupInfo& group) {
    each(table, "spring", [&](const std::string& name, const std::string& key, const auto& node) {
      const Eigen::Index j = column(node, group, name);
      const toml::table* spring = node.as_table();
      if (spring == nullptr || !spring->contains("stiffness")) {
        read_.wrong(node, key, "{ stiffness = ..., rest = ... }");
        return;
      }
      for (const auto& [word, value] : *spring) {
        const std::string what(word.str());
        Eigen::VectorXd* to = what == "stiffness" ? &terms_.stiffness
                              : what == "rest"    ? &terms_.rest
                                                  : nullptr;
        if (to == nullptr) {
          read_.unknown_key(value, what, {"stiffness", "rest"});
          continue;
        }
        const double x = number(value, key + "." + what);
        if (j >= 0) (*to)[j] = x;
      }
    });
  }
  void damping(const toml::node& table) {
    each(table, "damping", [&](const std::string& name, const std::string& key, const auto& node) {
      int i = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), i);
      if (error != std::errc() || end != name.data() + name.size() || i < 1 || i > n_) {
        read_.wrong(node, "damping",
                    fmt::format("the number of a velocity, 1 to {}, got '{}'", n_, name));
        return;
      }
      terms_.damping[i - 1] = number(node, key);
    });
  }

  const Registry& registry_;
  std::string origin_;
  TomlReader read_;
  Eigen::Index n_ = 0;
  Terms terms_;
};

}  // namespace

namespace {
std::vector<FileKind>& kinds() {
  static std::vector<FileKind> all;
  return all;
}
}  // namespace

const std::vector<FileKind>& file_kinds() { return kinds(); }
void add_file_kind(FileKind kind) { kinds().push_back(std::move(kind)); }

SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin) {
  return File(registry, origin).read(text);
}

std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path) {
  return [&registry, path](const Parameters& given) {
    return data_system_maker(registry, path, read_text_file("system", path))(given);
  };
}

std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path,
                                                                const std::string& text) {
  return [&registry, path, text](const Parameters& given) {
    const toml::table table = TomlReader(path).parse(text);
    for (const FileKind& kind : file_kinds()) {
      if (table.contains(kind.key)) return kind.read(text, path, given);
    }
    if (!given.empty()) {
      throw ConfigError({fmt::format("set: {} is a file with no parameters, got '{}'", path,
                                     given.begin()->first)});
    }
    return data_system(registry, text, path);
  };
}

}  // namespace hamel
