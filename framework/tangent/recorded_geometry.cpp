#include <hamel/framework/tangent/recorded_geometry.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace hamel {
namespace {

// R^n, of any n.
class RecordedTranslations final : public RecordedGeometry {
 public:
  explicit RecordedTranslations(int n) : n_(n) {}
  int dim() const override { return n_; }
  int size() const override { return n_; }
  int columns() const override { return n_; }
  void from_coordinates(const Traced* c, Traced* g) const override { copy(c, g); }
  void coordinates(const Traced* from, const Traced* way, Traced* out) const override {
    compose(from, way, out);
  }
  void compose(const Traced* g, const Traced* h, Traced* out) const override {
    for (int i = 0; i < n_; ++i) out[i] = g[i] + h[i];
  }
  void inverse(const Traced* g, Traced* out) const override {
    for (int i = 0; i < n_; ++i) out[i] = -g[i];
  }
  void Ad_transpose(const Traced* /*g*/, const Traced* mu, Traced* out) const override {
    copy(mu, out);
  }
  void tau(const Traced* xi, Traced* out) const override { copy(xi, out); }
  void tau_inverse(const Traced* g, Traced* out) const override { copy(g, out); }
  void base_momentum(double s, const Traced* /*xi*/, const Traced* p, const Traced* nu,
                     Traced* out) const override {
    for (int i = 0; i < n_; ++i) out[i] = p[i] - (1 - s) * nu[i];
  }

 private:
  void copy(const Traced* from, Traced* to) const {
    if (from != to) std::copy_n(from, n_, to);
  }
  int n_;
};

class RecordedProduct final : public RecordedGeometry {
 public:
  explicit RecordedProduct(std::vector<std::shared_ptr<const RecordedGeometry>> factors) {
    for (auto& factor : factors) {
      factors_.push_back({std::move(factor), dim_, size_, columns_});
      const RecordedGeometry& of = *factors_.back().geometry;
      dim_ += of.dim();
      size_ += of.size();
      columns_ += of.columns();
    }
  }
  int dim() const override { return dim_; }
  int size() const override { return size_; }
  int columns() const override { return columns_; }
  void from_coordinates(const Traced* c, Traced* g) const override {
    for (const Factor& f : factors_) f.geometry->from_coordinates(c + f.column, g + f.element);
  }
  void coordinates(const Traced* from, const Traced* way, Traced* out) const override {
    for (const Factor& f : factors_)
      f.geometry->coordinates(from + f.column, way + f.element, out + f.column);
  }
  void compose(const Traced* g, const Traced* h, Traced* out) const override {
    for (const Factor& f : factors_)
      f.geometry->compose(g + f.element, h + f.element, out + f.element);
  }
  void inverse(const Traced* g, Traced* out) const override {
    for (const Factor& f : factors_) f.geometry->inverse(g + f.element, out + f.element);
  }
  void Ad_transpose(const Traced* g, const Traced* mu, Traced* out) const override {
    for (const Factor& f : factors_) f.geometry->Ad_transpose(g + f.element, mu + f.at, out + f.at);
  }
  void tau(const Traced* xi, Traced* out) const override {
    for (const Factor& f : factors_) f.geometry->tau(xi + f.at, out + f.element);
  }
  void tau_inverse(const Traced* g, Traced* out) const override {
    for (const Factor& f : factors_) f.geometry->tau_inverse(g + f.element, out + f.at);
  }
  void base_momentum(double s, const Traced* xi, const Traced* p, const Traced* nu,
                     Traced* out) const override {
    for (const Factor& f : factors_)
      f.geometry->base_momentum(s, xi + f.at, p + f.at, nu + f.at, out + f.at);
  }

 private:
  struct Factor {
    std::shared_ptr<const RecordedGeometry> geometry;
    int at, element, column;
  };
  std::vector<Factor> factors_;
  int dim_ = 0, size_ = 0, columns_ = 0;
};

using GeometryTable =
    std::map<std::pair<std::string, std::string>, std::shared_ptr<const RecordedGeometry>>;

GeometryTable& recorded_geometries() {
  static GeometryTable all;
  return all;
}

}  // namespace

std::shared_ptr<const RecordedGeometry> recorded_product(
    std::vector<std::shared_ptr<const RecordedGeometry>> factors) {
  return std::make_shared<RecordedProduct>(std::move(factors));
}

void add_recorded_geometry(const std::string& group, const std::string& retraction,
                           std::shared_ptr<const RecordedGeometry> geometry) {
  recorded_geometries()[{group, retraction}] = std::move(geometry);
}

std::shared_ptr<const RecordedGeometry> recorded_geometry(const GroupInfo& group,
                                                          const std::string& retraction) {
  std::vector<std::shared_ptr<const RecordedGeometry>> factors;
  for (const GroupFactor& factor : group.factors) {
    const auto found = recorded_geometries().find({factor.name, retraction});
    if (found != recorded_geometries().end()) {
      factors.push_back(found->second);
    } else if (factor.name == "r" + std::to_string(factor.dim)) {
      factors.push_back(std::make_shared<RecordedTranslations>(factor.dim));
    } else {
      return nullptr;
    }
  }
  if (factors.empty()) return nullptr;
  return factors.size() == 1 ? factors.front() : recorded_product(std::move(factors));
}

}  // namespace hamel
