#include <hamel/framework/data_system.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <hamel/framework/differences.hpp>
#include <hamel/framework/mechanics.hpp>

namespace hamel {
namespace {

// V = sum weight x + 1/2 stiffness (x - rest)^2 over columns x of the element; f_i = -damping_i xi_i.
struct Terms {
  Eigen::VectorXd weight, stiffness, rest;  // a number for each column
  Eigen::VectorXd damping;                  // n
  bool potential() const { return (weight.array() != 0).any() || (stiffness.array() != 0).any(); }
};

class DataMechanics final : public Mechanics {
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
  void force(double /*t*/, const double* g, ConstVector xi, Vector out) const override {
    out = -terms_.damping.cwiseProduct(xi);
    if (!terms_.potential()) return;
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      axis_ = Eigen::VectorXd::Unit(dim(), i);
      differentiate_along(*geometry_, g, axis_, step_, moved_, [&](double, double weight) {
        out[i] -= weight * potential(moved_.data());
      });
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
      : registry_(registry), origin_(origin) {}

  SystemModel read(const std::string& text) {
    toml::table table;
    try {
      table = toml::parse(text);
    } catch (const toml::parse_error& error) {
      const auto at = error.source().begin;
      throw ConfigError(
          {fmt::format("{}:{}:{}: {}", origin_, at.line, at.column, error.description())});
    }
    static const std::vector<std::string> keys = {
        "configuration", "constraints", "damping", "drift",  "group",   "inertia",
        "linear",        "momentum",    "name",    "spring", "summary", "velocity"};
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(keys.begin(), keys.end(), name) == keys.end()) {
        wrong(node, unknown_name("key", name, keys));
      }
    }
    SystemModel model;
    model.name = table["name"].value_or(origin_);
    const std::string group = table["group"].value_or("");
    const auto info = registry_.group_or_product(group);
    if (!info) {
      if (const auto* node = table.get("group")) {
        wrong(*node, unknown_name("group", group, registry_.groups()));
      } else {
        mistakes_.push_back(
            fmt::format("{}: group: missing, expected the name of a group", origin_));
      }
      throw ConfigError(mistakes_);
    }
    model.group = *info;
    const Eigen::Index n = model.group.dim;
    Eigen::MatrixXd inertia = Eigen::MatrixXd::Identity(n, n), a(0, n);
    if (const auto* node = table.get("inertia")) inertia = matrix(*node, "inertia", n, true);
    else mistakes_.push_back(fmt::format("{}: inertia: missing, expected {} entries", origin_, n));
    if (const auto* node = table.get("constraints")) a = matrix(*node, "constraints", n, false);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
    if (const auto* node = table.get("drift")) b = numbers(*node, "drift", a.rows());
    for (const auto& [key, to] : {std::pair{"configuration", &model.start.configuration},
                                  std::pair{"velocity", &model.start.velocity},
                                  std::pair{"momentum", &model.start.momentum}}) {
      const auto* node = table.get(key);
      if (node == nullptr) continue;
      const bool columns = std::string(key) == "configuration";
      const Eigen::VectorXd values =
          numbers(*node, key, columns ? static_cast<Eigen::Index>(model.group.columns.size()) : n);
      to->assign(values.begin(), values.end());
    }
    const Terms terms = read_terms(table, model.group);
    if (!mistakes_.empty()) throw ConfigError(mistakes_);
    const bool invariant = !terms.potential() && b.isZero(0) && terms.damping.isZero(0);
    if (invariant) {
      model.inertia = inertia;
      model.constraints = a;
    } else {
      model.mechanics =
          std::make_shared<DataMechanics>(inertia, a, b, terms, registry_.geometry(group, "exp"));
    }
    return model;
  }

 private:
  void wrong(const toml::node& node, const std::string& what) {
    const auto at = node.source().begin;
    mistakes_.push_back(fmt::format("{}:{}:{}: {}", origin_, at.line, at.column, what));
  }
  double number(const toml::node& node, const std::string& key) {
    const auto value = node.value<double>();
    if (!value || !std::isfinite(*value)) wrong(node, key + ": expected a finite number");
    return value.value_or(0);
  }
  Eigen::VectorXd numbers(const toml::node& node, const std::string& key, Eigen::Index count) {
    const toml::array* array = node.as_array();
    if (array == nullptr || static_cast<Eigen::Index>(array->size()) != count) {
      wrong(node, fmt::format("{}: expected {} numbers", key, count));
      return Eigen::VectorXd::Zero(count);
    }
    Eigen::VectorXd out(count);
    for (Eigen::Index i = 0; i < count; ++i) out[i] = number((*array)[static_cast<size_t>(i)], key);
    return out;
  }
  // Rows of n; where square, n numbers are its diagonal.
  Eigen::MatrixXd matrix(const toml::node& node, const std::string& key, Eigen::Index n,
                         bool square) {
    const toml::array* array = node.as_array();
    const Eigen::MatrixXd nothing =
        square ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)) : Eigen::MatrixXd(0, n);
    if (array == nullptr || (square && static_cast<Eigen::Index>(array->size()) != n)) {
      wrong(node, fmt::format("{}: expected {}", key,
                              square ? fmt::format("{} numbers or {} rows", n, n)
                                     : fmt::format("rows of {} numbers", n)));
      return nothing;
    }
    if (square && !array->empty() && !array->front().is_array()) {
      return numbers(node, key, n).asDiagonal();
    }
    Eigen::MatrixXd out(static_cast<Eigen::Index>(array->size()), n);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      out.row(i) = numbers((*array)[static_cast<size_t>(i)], key, n).transpose();
    }
    return out;
  }

  Terms read_terms(const toml::table& table, const GroupInfo& group) {
    const auto columns = static_cast<Eigen::Index>(group.columns.size());
    Terms out{Eigen::VectorXd::Zero(columns), Eigen::VectorXd::Zero(columns),
              Eigen::VectorXd::Zero(columns), Eigen::VectorXd::Zero(group.dim)};
    const auto each = [&](const char* key, const auto& visit) {
      const toml::node* node = table.get(key);
      if (node == nullptr) return;
      const toml::table* entries = node->as_table();
      if (entries == nullptr) {
        wrong(*node, fmt::format("{}: expected a table", key));
        return;
      }
      for (const auto& [name, value] : *entries) visit(std::string(name.str()), value);
    };
    const auto column = [&](const std::string& name, const toml::node& node) -> Eigen::Index {
      const auto it = std::find(group.columns.begin(), group.columns.end(), name);
      if (it == group.columns.end()) {
        wrong(node, unknown_name("column of " + group.name, name, group.columns));
        return 0;
      }
      return it - group.columns.begin();
    };
    each("linear", [&](const std::string& name, const toml::node& node) {
      out.weight[column(name, node)] = number(node, "linear." + name);
    });
    each("spring", [&](const std::string& name, const toml::node& node) {
      const Eigen::Index j = column(name, node);
      const toml::table* spring = node.as_table();
      if (spring == nullptr || spring->get("stiffness") == nullptr) {
        wrong(node, fmt::format("spring.{}: expected {{ stiffness = ..., rest = ... }}", name));
        return;
      }
      out.stiffness[j] = number(*spring->get("stiffness"), "spring." + name + ".stiffness");
      if (const auto* rest = spring->get("rest")) {
        out.rest[j] = number(*rest, "spring." + name + ".rest");
      }
    });
    each("damping", [&](const std::string& name, const toml::node& node) {
      int i = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), i);
      if (error != std::errc() || end != name.data() + name.size() || i < 1 || i > group.dim) {
        wrong(node,
              fmt::format("damping: got '{}', expected a number from 1 to {}", name, group.dim));
        return;
      }
      out.damping[i - 1] = number(node, "damping." + name);
    });
    return out;
  }

  const Registry& registry_;
  const std::string& origin_;
  std::vector<std::string> mistakes_;
};

}  // namespace

SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin) {
  return File(registry, origin).read(text);
}

std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path) {
  return [&registry, path](const Parameters& given) {
    if (!given.empty()) {
      throw ConfigError({fmt::format("set: {} is a file with no parameters, got '{}'", path,
                                     given.begin()->first)});
    }
    std::ifstream in(path);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf())) {
      throw ConfigError({fmt::format("system: cannot read '{}'", path)});
    }
    return data_system(registry, text.str(), path);
  };
}

}  // namespace hamel
