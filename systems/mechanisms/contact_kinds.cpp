// The kinds of contacts by name, and their rows from one formula each.
#include <hamel/systems/mechanisms/contacts/ball_contact.hpp>
#include <hamel/systems/mechanisms/contacts/blade_contact.hpp>
#include <hamel/systems/mechanisms/contacts/ellipsoid_contact.hpp>
#include <hamel/systems/mechanisms/contacts/point_contact.hpp>
#include <hamel/systems/mechanisms/contacts/roller_contact.hpp>
#include <hamel/systems/mechanisms/contacts/tube_contact.hpp>
#include <hamel/systems/mechanisms/contacts/wheel_contact.hpp>
#include <hamel/systems/mechanisms/ground_contact.hpp>
#include <hamel/systems/mechanisms/programs/contact_view.hpp>

namespace hamel::mechanisms {
namespace {

// u . v_ground(q).
template <class T>
T drift(const ContactView<T>& view, const Ground& ground, const VecT<T, 3>& q,
        const VecT<T, 3>& u) {
  const VecT<T, 3> x = view.point_in_world(q), along = view.direction_in_world(u);
  const VecT<T, 3> v = {ground.velocity[0] - ground.rate * x[1],
                        ground.velocity[1] + ground.rate * x[0], T(ground.velocity[2])};
  return v.dot(along);
}

template <class Kind>
class ContactOf final : public ContactModel {
  template <class T>
  using Touch = decltype(Kind().touch(std::declval<ContactView<T>>()));
  static constexpr size_t n = Touch<double>::count;

 public:
  explicit ContactOf(const Kind& kind) : ContactModel(n), kind_(kind) {}
  std::vector<std::string> meanings() const override { return Kind::meanings(); }
  bool of_world() const override {
    if constexpr (requires { Kind::of_world; }) return Kind::of_world;
    else return false;
  }
  std::vector<Vec3> axes() const override {
    if constexpr (requires { kind_.axes(); }) return kind_.axes();
    std::vector<Vec3> out;
    for (const Field& field : fields_of<Kind>(kind_))
      if (is_direction(field)) out.emplace_back(field.value.data());
    return out;
  }
  double radius() const override {
    if constexpr (requires { kind_.radius; }) return kind_.radius;
    else return 0;
  }
  std::string flaw() const override {
    if constexpr (requires { kind_.flaw(); }) return kind_.flaw();
    else return "";
  }
  std::vector<BodyShape> shapes(const Point& at) const override { return kind_.shapes(at); }

  void rows(const Contact& contact, const Tree& tree, const Ground& ground,
            Row* out) const override {
    const ContactView<double> view = seen(contact, tree, ground);
    const auto touch = kind_.touch(view);
    const auto set = [&](const Vec3& u) {
      out->link = contact.link;
      out->wrench = force_at(touch.point, u);
    };
    for (const Vec3& u : touch.directions) {
      set(u);
      if (ground.moves()) out->drift = drift(view, ground, touch.point, u);
      ++out;
    }
    set(view.vertical);
    const Vec3 x = view.point_in_world(touch.point);
    out->phi = x[2];
    if (!ground.height) return;
    const GroundPoint at = ground_at(*ground.height, foot(contact, tree, ground));
    out->phi = at.normal.dot(x - at.point);
  }

  RecordedContact record(const ContactView<Number>& view, const Ground& ground) const override {
    const auto touch = kind_.touch(view);
    RecordedContact out{touch.point, {touch.directions.begin(), touch.directions.end()}, {}};
    for (const NumberVec3& u : touch.directions)
      out.drifts.push_back(ground.moves() ? drift(view, ground, touch.point, u) : Number(0));
    return out;
  }

  Vec3 touch(const Contact& contact, const Tree& tree, const Ground& ground) const override {
    const ContactView<double> view = seen(contact, tree, ground);
    return view.point_in_world(kind_.touch(view).point);
  }
  Vec<2> foot(const Contact& contact, const Tree& tree, const Ground& ground) const override {
    return find_foot(*ground.height, ContactView<double>(contact, tree),
                     [this](const ContactView<double>& view) { return kind_.touch(view).point; });
  }

 private:
  ContactView<double> seen(const Contact& contact, const Tree& tree, const Ground& ground) const {
    ContactView<double> view(contact, tree);
    if (ground.height)
      stand_on(ground_at(*ground.height, foot(contact, tree, ground)).normal, view);
    return view;
  }
  Kind kind_;
};

template <class Kind>
ContactKind kind() {
  const auto make = [](const Parameters& values) -> std::shared_ptr<const ContactModel> {
    return std::make_shared<ContactOf<Kind>>(with_parameters<Kind>(values));
  };
  return {Kind::name(), Kind::summary(), fields_of<Kind>(), make};
}

}  // namespace

const std::vector<ContactKind>& contact_kinds() {
  static const std::vector<ContactKind> all = {
      kind<BallContact>(),   kind<BladeContact>(), kind<EllipsoidContact>(), kind<PointContact>(),
      kind<RollerContact>(), kind<TubeContact>(),  kind<WheelContact>(),
  };
  return all;
}

const ContactKind* find_contact_kind(const std::string& name) {
  for (const ContactKind& kind : contact_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

ContactModel::~ContactModel() = default;

}  // namespace hamel::mechanisms
