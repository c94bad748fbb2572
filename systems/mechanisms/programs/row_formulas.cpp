#include <hamel/systems/mechanisms/programs/row_formulas.hpp>

#include <optional>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/agreement_formulas.hpp>
#include <hamel/systems/mechanisms/programs/contact_view.hpp>

namespace hamel::mechanisms {
namespace {

// A ground z = h(x, y) at a foot, recorded.
struct RecordedGround {
  NumberVec3 point, normal, along_x, along_y;

  RecordedGround(const Expression& height, const Number& x, const Number& y) {
    const std::vector<Number> at = {x, y};
    const Number h = height.record(at);
    const std::vector<Number> slope = graph::gradient({h}, {1}, at);
    point = {x, y, h};
    along_x = {1, 0, slope[0]};
    along_y = {0, 1, slope[1]};
    normal = {-slope[0], -slope[1], 1};
    normal *= 1 / sqrt(normal.squaredNorm());
  }
};

void stand_on(const NumberVec3& normal, ContactView<Number>& view) {
  view.sloping = true;
  view.vertical = normal[0] * view.world_axis(0) + normal[1] * view.world_axis(1) +
                  normal[2] * view.world_axis(2);
}

class RowRecorder {
 public:
  explicit RowRecorder(const BodyFormulas& bodies) : bodies_(bodies) {}

  RecordedRow& add() {
    RecordedRow& row = rows.emplace_back();
    row.coefficients.resize(static_cast<size_t>(bodies_.dim()));
    return row;
  }
  // u . (velocity of the point q of a link), or with side = -1 its negative, onto a row.
  void add_velocity(int link, const NumberVec3& q, const NumberVec3& u, double side,
                    RecordedRow& row) const {
    bodies_.each_effect(link, q, u, [&](int i, const Number& effect) {
      row.coefficients[static_cast<size_t>(i)] += side * effect;
    });
    row.value += side * dot(u, bodies_.velocity(link, q));
  }
  void add_turning(int link, const NumberVec3& u, double side, RecordedRow& row) const {
    bodies_.each_turning(link, u, [&](int i, const Number& effect) {
      row.coefficients[static_cast<size_t>(i)] += side * effect;
    });
    row.value += side * dot(u, bodies_.turning(link));
  }
  // foot: of a ground that has a height.
  void add_contact(const Contact& contact, const Ground& ground, std::span<const Number> foot) {
    ContactView<Number> view(contact, bodies_);
    std::optional<RecordedGround> surface;
    if (ground.height) {
      surface.emplace(*ground.height, foot[0], foot[1]);
      stand_on(surface->normal, view);
    }
    const RecordedContact touch = contact.model->record(view, ground);
    for (size_t i = 0; i < touch.directions.size(); ++i) {
      RecordedRow& row = add();
      add_velocity(contact.link, touch.point, touch.directions[i], 1, row);
      row.drift = touch.drifts[i];
      row.value -= row.drift;
    }
    RecordedRow& height = add();
    add_velocity(contact.link, touch.point, view.vertical, 1, height);
    const NumberVec3 x = view.point_in_world(touch.point);
    height.phi = surface ? dot(surface->normal, x - surface->point) : x[2];
  }
  // The formulas of closed_loop.hpp, seen from the one root of both links, else from the world.
  void add_loop(const Loop& loop) {
    if (loop.surface) return add_pair(loop);
    const bool one_root = loop.a != kGround && loop.b != kGround && root(loop.a) == root(loop.b);
    const auto seen = [&](int link, const NumberVec3& u) {
      return one_root || link == kGround ? u : bodies_.root_in_world(link).turn(u);
    };
    const auto back = [&](int link, const NumberVec3& u) {
      return one_root || link == kGround ? u : bodies_.root_in_world(link).turn_back(u);
    };
    const NumberVec3 on_b = bodies_.point(loop.b, loop.at);
    const auto in_world = [&](int link, const NumberVec3& x) {
      return one_root || link == kGround ? x : bodies_.root_in_world(link).apply(x);
    };
    const NumberVec3 apart =
        in_world(loop.b, on_b) - in_world(loop.a, bodies_.point(loop.a, loop.at));
    const auto point_of_a = [&]() -> NumberVec3 {
      if (one_root) return on_b;
      const NumberVec3 x = in_world(loop.b, on_b);
      if (loop.a == kGround) return x;
      const Pose& to = bodies_.root_in_world(loop.a);
      return to.turn_back(x - to.position);
    };
    const NumberVec3 on_a = point_of_a();
    const Mat<3, 3> frame = loop.is_hinge() ? frame_along(loop.axis) : Mat<3, 3>::Identity();
    std::array<NumberVec3, 3> e;
    for (int i = 0; i < 3; ++i) {
      NumberVec3& u = e[static_cast<size_t>(i)];
      u = seen(loop.a, bodies_.direction(loop.a, frame.col(i)));
      RecordedRow& row = add();
      add_velocity(loop.b, on_b, back(loop.b, u), 1, row);
      add_velocity(loop.a, on_a, back(loop.a, u), -1, row);
      row.phi = dot(u, apart);
    }
    if (!loop.is_hinge()) return;
    const NumberVec3 axis = seen(loop.b, bodies_.direction(loop.b, loop.axis));
    for (size_t i = 0; i < 2; ++i) {
      const NumberVec3 moment = cross(axis, e[i]);
      RecordedRow& row = add();
      add_turning(loop.b, back(loop.b, moment), 1, row);
      add_turning(loop.a, back(loop.a, moment), -1, row);
      row.phi = dot(e[i], axis);
    }
  }

  // The formulas of rolling_pair.hpp, seen from the world.
  void add_pair(const Loop& loop) {
    const auto turned = [&](int link, const NumberVec3& u) {
      return link == kGround ? u : bodies_.root_in_world(link).turn(u);
    };
    const auto moved = [&](int link, const NumberVec3& x) {
      return link == kGround ? x : bodies_.root_in_world(link).apply(x);
    };
    const PairPoint<Number> touch = find_pair_point<Number>(
        *loop.surface, loop.at, moved(loop.b, bodies_.point(loop.b, loop.at)),
        [&](const Vec3& x) { return moved(loop.a, bodies_.point(loop.a, x)); },
        [&](const Vec3& u) { return turned(loop.a, bodies_.direction(loop.a, u)); });
    for (size_t i = 0; i < 3; ++i) {
      RecordedRow& row = add();
      for (const auto& [link, side] : {std::pair{loop.b, 1.0}, std::pair{loop.a, -1.0}}) {
        if (link == kGround) continue;
        const Pose& root = bodies_.root_in_world(link);
        add_velocity(link, root.turn_back(touch.point - root.position),
                     root.turn_back(touch.directions[i]), side, row);
      }
      if (i == 2) row.phi = touch.gap;
    }
  }

  // The derivatives of its formula by the coordinates, or by the velocities, as coefficients.
  void add_coupling(const Coupling& coupling, const std::vector<int>& links,
                    const RowInputs& inputs) {
    std::vector<Number> variables(coupling.links.size());
    for (size_t i = 0; i < variables.size(); ++i) {
      const auto at = std::ranges::find(links, coupling.links[i]);
      if (at != links.end()) variables[i] = inputs.coupled[static_cast<size_t>(at - links.begin())];
    }
    for (const int i : coupling.velocities) variables.push_back(inputs.xi[static_cast<size_t>(i)]);
    const Number formula = coupling.formula.record(variables);
    RecordedRow& row = add();
    if (coupling.affine) {
      std::vector<Number> at_rest = variables;
      std::fill(at_rest.begin() + static_cast<std::ptrdiff_t>(coupling.links.size()), at_rest.end(),
                Number(0));
      row.drift = -coupling.formula.record(at_rest);
      row.value -= row.drift;
    }
    for (const size_t i : coupling.formula.used()) {
      const bool of_coordinate = i < coupling.links.size();
      if (of_coordinate && coupling.of_rates()) continue;
      const Number slope = graph::gradient({formula}, {1}, {variables[i]}).front();
      const int dof = of_coordinate ? bodies_.tree().first(coupling.links[i])
                                    : coupling.velocities[i - coupling.links.size()];
      row.coefficients[static_cast<size_t>(dof)] += slope;
      row.value += slope * inputs.xi[static_cast<size_t>(dof)];
    }
  }

  std::vector<RecordedRow> rows;

 private:
  int root(int link) const {
    while (bodies_.tree().parent(link) != kGround) link = bodies_.tree().parent(link);
    return link;
  }
  const BodyFormulas& bodies_;
};

}  // namespace

std::vector<RecordedRow> record_rows(const ConstraintRows& rows, const BodyFormulas& bodies,
                                     const RowInputs& inputs) {
  RowRecorder out(bodies);
  for (size_t i = 0; i < rows.contacts.size(); ++i)
    out.add_contact(rows.contacts[i], rows.ground,
                    rows.ground.height ? inputs.feet.subspan(2 * i, 2) : inputs.feet);
  for (const Loop& loop : rows.loops) out.add_loop(loop);
  for (size_t i = 0; i < rows.couplings.size(); ++i) {
    out.add_coupling(rows.couplings[i], rows.coupled_links, inputs);
    if (!rows.couplings[i].of_rates()) out.rows.back().phi = inputs.closures[i];
  }
  const size_t before = out.rows.size();
  for (size_t i = 0; i < rows.prescribed.size(); ++i) {
    RecordedRow& row = out.add();
    const auto dof = static_cast<size_t>(rows.prescribed[i].dof);
    row.coefficients[dof] = 1;
    row.drift = inputs.rates[i];
    row.value = inputs.xi[dof] - inputs.rates[i];
    row.phi = inputs.gaps[i];
  }
  std::vector<RecordedRow> agreements;
  for (const Agreement& agreement : rows.agreements)
    agreements.push_back(agreement_row(agreement, out.rows, bodies, rows, inputs));
  out.rows.insert(out.rows.begin() + static_cast<std::ptrdiff_t>(before), agreements.begin(),
                  agreements.end());
  return std::move(out.rows);
}

std::vector<Number> record_feet(const ConstraintRows& rows, const BodyFormulas& bodies,
                                std::span<const Number> feet) {
  std::vector<Number> out;
  for (size_t i = 0; i < feet.size() / 2; ++i) {
    const RecordedGround ground(*rows.ground.height, feet[2 * i], feet[2 * i + 1]);
    ContactView<Number> view(rows.contacts[i], bodies);
    stand_on(ground.normal, view);
    const RecordedContact touch = rows.contacts[i].model->record(view, rows.ground);
    const NumberVec3 gap = view.point_in_world(touch.point) - ground.point;
    out.push_back(dot(gap, ground.along_x));
    out.push_back(dot(gap, ground.along_y));
  }
  return out;
}

}  // namespace hamel::mechanisms
