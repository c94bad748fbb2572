// Groups over recorded numbers, by name: equations of steps are recorded with them
// (framework/tangent/recorded_geometry.hpp).
#include <algorithm>
#include <memory>

#include <hamel/framework/tangent/recorded_geometry.hpp>
#include <hamel/groups/all.hpp>
#include <hamel/systems/recorded_groups.hpp>

namespace hamel {

// Turns are not counted: they are no function of the recorded numbers.
template <>
inline SO2Element<Traced> SO2::compose(const SO2Element<Traced>& g, const SO2Element<Traced>& h) {
  return {g.c * h.c - g.s * h.s, g.s * h.c + g.c * h.s, 0};
}
template <>
inline SO2Element<Traced> SO2::inverse(const SO2Element<Traced>& g) {
  return {g.c, -g.s, 0};
}

namespace {

// Elements as numbers.
template <class G>
struct RecordedElements;

template <>
struct RecordedElements<SO2> {
  static constexpr int size = 2, columns = 1;
  static SO2Element<Traced> load(const Traced* x) { return {x[0], x[1], 0}; }
  static void store(const SO2Element<Traced>& g, Traced* x) {
    x[0] = g.c;
    x[1] = g.s;
  }
  static SO2Element<Traced> from(const Traced* c) { return {cos(c[0]), sin(c[0]), 0}; }
  static void coordinates(const Traced* from, const SO2Element<Traced>& way, Traced* out) {
    out[0] = from[0] + atan2(way.s, way.c);
  }
};

template <>
struct RecordedElements<SE2> {
  static constexpr int size = 4, columns = 3;
  static SE2Element<Traced> load(const Traced* x) {
    return {RecordedElements<SO2>::load(x), {x[2], x[3]}};
  }
  static void store(const SE2Element<Traced>& g, Traced* x) {
    RecordedElements<SO2>::store(g.rotation, x);
    x[2] = g.translation[0];
    x[3] = g.translation[1];
  }
  static SE2Element<Traced> from(const Traced* c) {
    return {RecordedElements<SO2>::from(c), {c[1], c[2]}};
  }
  static void coordinates(const Traced* from, const SE2Element<Traced>& way, Traced* out) {
    const SE2Element<Traced> g = SE2::compose(RecordedElements::from(from), way);
    RecordedElements<SO2>::coordinates(from, way.rotation, out);
    out[1] = g.translation[0];
    out[2] = g.translation[1];
  }
};

template <>
struct RecordedElements<SO3> {
  static constexpr int size = 9, columns = 9;
  using Element = MatT<Traced, 3, 3>;
  static Element load(const Traced* x) {
    Element g;
    for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = x[i];
    return g;
  }
  static void store(const Element& g, Traced* x) {
    for (int i = 0; i < 9; ++i) x[i] = g(i / 3, i % 3);
  }
  static Element from(const Traced* c) { return load(c); }
  static void coordinates(const Traced* from, const Element& way, Traced* out) {
    store(SO3::compose(load(from), way), out);
  }
};

template <>
struct RecordedElements<Heisenberg> {
  static constexpr int size = 3, columns = 3;
  using Element = VecT<Traced, 3>;
  static Element load(const Traced* x) { return {x[0], x[1], x[2]}; }
  static void store(const Element& g, Traced* x) { std::copy_n(g.data(), 3, x); }
  static Element from(const Traced* c) { return load(c); }
  static void coordinates(const Traced* from, const Element& way, Traced* out) {
    store(Heisenberg::compose(load(from), way), out);
  }
};

template <>
struct RecordedElements<SE3> {
  static constexpr int size = 12, columns = 12;
  using Element = SE3Element<Traced>;
  static Element load(const Traced* x) {
    return {RecordedElements<SO3>::load(x), {x[9], x[10], x[11]}};
  }
  static void store(const Element& g, Traced* x) {
    RecordedElements<SO3>::store(g.rotation, x);
    for (int i = 0; i < 3; ++i) x[9 + i] = g.translation[i];
  }
  static Element from(const Traced* c) { return load(c); }
  static void coordinates(const Traced* from, const Element& way, Traced* out) {
    store(SE3::compose(load(from), way), out);
  }
};

template <class Tau>
class TypedRecordedGeometry final : public RecordedGeometry {
  using G = typename Tau::Group;
  using Elements = RecordedElements<G>;
  static constexpr int n = G::dim;
  using Vector = VecT<Traced, n>;
  static Vector vector(const Traced* x) {
    Vector out;
    std::copy_n(x, n, out.data());
    return out;
  }
  static void put(const Vector& x, Traced* out) { std::copy_n(x.data(), n, out); }

 public:
  int dim() const override { return n; }
  int size() const override { return Elements::size; }
  int columns() const override { return Elements::columns; }
  void from_coordinates(const Traced* c, Traced* g) const override {
    Elements::store(Elements::from(c), g);
  }
  void coordinates(const Traced* from, const Traced* way, Traced* out) const override {
    Elements::coordinates(from, Elements::load(way), out);
  }
  void compose(const Traced* g, const Traced* h, Traced* out) const override {
    Elements::store(G::compose(Elements::load(g), Elements::load(h)), out);
  }
  void inverse(const Traced* g, Traced* out) const override {
    Elements::store(G::inverse(Elements::load(g)), out);
  }
  void Ad_transpose(const Traced* g, const Traced* mu, Traced* out) const override {
    put(G::Ad_transpose(Elements::load(g), vector(mu)), out);
  }
  void tau(const Traced* xi, Traced* out) const override {
    Elements::store(Tau::tau(vector(xi)), out);
  }
  void tau_inverse(const Traced* g, Traced* out) const override {
    put(Tau::tau_inverse(Elements::load(g)), out);
  }
  void base_momentum(double s, const Traced* xi, const Traced* p, const Traced* nu,
                     Traced* out) const override {
    put(hamel::base_momentum<Tau, Traced>(s, vector(xi), vector(p), vector(nu)), out);
  }
};

template <class Tau>
void add_recorded() {
  add_recorded_geometry(Tau::Group::name(), Tau::name(),
                        std::make_shared<TypedRecordedGeometry<Tau>>());
}

}  // namespace

void add_recorded_groups() {
  add_recorded<Exp<SO2>>();
  add_recorded<Cayley<SO2>>();
  add_recorded<Exp<SE2>>();
  add_recorded<Cayley<SE2>>();
  add_recorded<Exp<SO3>>();
  add_recorded<Cayley<SO3>>();
  add_recorded<Exp<SE3>>();
  add_recorded<Cayley<SE3>>();
  add_recorded<Exp<Heisenberg>>();
  add_recorded<Cayley<Heisenberg>>();
}

}  // namespace hamel
