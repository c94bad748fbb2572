#include <hamel/framework/check/contact_laws.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/driver.hpp>

namespace hamel {
namespace check {
namespace {

constexpr double kOfRun = 1e-9;
// The part of the velocity that a force of one contact makes, below which is round-off of rest.
constexpr double kOfForce = 1e-6;
constexpr double kOfBalance = 1e-7;  // the quadrature of work adds its own errors

// Slip, gap and reactions of one contact at a node.
struct ContactNode {
  int mode = 0;
  double gap = 0, normal = 0, way = 0;  // way: sum of the parts of slip and gap rate
  Eigen::Vector2d slip = Eigen::Vector2d::Zero(), friction = Eigen::Vector2d::Zero();
};

// All contacts along a run, node by node.
class ContactNodes {
 public:
  explicit ContactNodes(const Result& result, const Run& run)
      : result_(result),
        system_(*result.system),
        mechanics_(*run.driver().plan().setup.mechanics),
        geometry_(*run.driver().plan().geometry),
        g_(geometry_.size()),
        xi_(mechanics_.dim()),
        b_(mechanics_.constraint_count()),
        phi_(mechanics_.holonomic_rows()),
        rows_(mechanics_.constraint_count(), mechanics_.dim()) {
    for (Eigen::Index row = 0; row < rows_.rows(); ++row)
      reactions_.push_back(result.trajectory.index(
          system_.reactions.empty() ? fmt::format("lambda{}", row + 1)
                                    : system_.reactions[static_cast<size_t>(row)]));
    for (const ContactLaw& law : system_.contact_laws)
      modes_.push_back(result.trajectory.index(law.name + ".mode"));
  }

  // How fast a force of 1 N at a contact can change its velocities, at the first row.
  double reach(size_t contact) {
    evaluate(0);
    Eigen::MatrixXd inertia(mechanics_.dim(), mechanics_.dim());
    mechanics_.inertia(g_.data(), inertia);
    const Eigen::LDLT<Eigen::MatrixXd> factors(inertia);
    const ContactLaw& law = system_.contact_laws[contact];
    double out = 0;
    const auto add = [&](int row) {
      out = std::max(out, rows_.row(row).dot(factors.solve(rows_.row(row).transpose())));
    };
    for (const int row : law.tangential) add(row);
    if (law.normal) add(*law.normal);
    return out;
  }

  // visit(contact, node) of each contact at each row.
  template <class Visit>
  void each(const Visit& visit) {
    for (size_t i = 0; i < result_.trajectory.rows(); ++i) {
      evaluate(i);
      for (size_t c = 0; c < modes_.size(); ++c) visit(c, node(i, c));
    }
  }

 private:
  double number(size_t row, size_t column) const { return result_.trajectory.at(row, column); }

  void evaluate(size_t row) {
    const size_t columns = system_.group.columns.size();
    const auto all = result_.trajectory.row(row);
    geometry_.from_coordinates(all.subspan(1, columns), g_.data());
    for (Eigen::Index j = 0; j < xi_.size(); ++j)
      xi_[j] = all[1 + columns + static_cast<size_t>(j)];
    mechanics_.constraints(all[0], g_.data(), rows_, b_);
    if (phi_.size() > 0) mechanics_.holonomic(g_.data(), phi_);
  }

  ContactNode node(size_t row, size_t contact) {
    const ContactLaw& law = system_.contact_laws[contact];
    ContactNode out;
    out.mode = static_cast<int>(number(row, modes_[contact]));
    const auto part_of_way = [&](int i) {
      return rows_.row(i).cwiseAbs().dot(xi_.cwiseAbs().transpose()) + std::abs(b_[i]);
    };
    out.normal = law.load;
    if (law.load_input)
      out.normal += result_.inputs->at(number(row, 0))[static_cast<Eigen::Index>(*law.load_input)];
    if (law.normal) {
      const Eigen::Index first = rows_.rows() - phi_.size();
      out.gap = phi_[*law.normal - first];
      out.normal = number(row, reactions_[static_cast<size_t>(*law.normal)]);
      out.way += part_of_way(*law.normal);
    }
    for (size_t k = 0; k < law.tangential.size(); ++k) {
      const int i = law.tangential[k];
      out.slip[static_cast<Eigen::Index>(k)] = rows_.row(i).dot(xi_.transpose()) - b_[i];
      out.friction[static_cast<Eigen::Index>(k)] = number(row, reactions_[static_cast<size_t>(i)]);
      out.way += part_of_way(i);
    }
    return out;
  }

  const Result& result_;
  const SystemModel& system_;
  const Mechanics& mechanics_;
  const Geometry& geometry_;
  std::vector<size_t> reactions_, modes_;  // columns
  Eigen::VectorXd g_, xi_, b_, phi_;
  Eigen::MatrixXd rows_;
};

struct ContactSizes {
  double way = 0, force = 0;
};

struct ContactViolations {
  Largest penetrates, open_pulls, parts, slips, beyond_cone, off_rim, works;

  void take(const ContactLaw& law, const ContactNode& at, const ContactSizes& size, double time) {
    const double mu = law.friction, held = at.normal, length = size.way * time;
    if (law.normal) penetrates(-at.gap / length);
    if (at.mode == static_cast<int>(ContactMode::open)) {
      open_pulls((std::abs(law.normal ? held : 0) + at.friction.norm()) / size.force);
      return;
    }
    if (law.normal) parts(std::abs(at.gap) / length);
    if (law.normal) beyond_cone(-held / size.force);
    works(at.friction.dot(at.slip) / (size.force * size.way));
    if (law.tangential.empty()) return;
    const double slip = at.slip.norm();
    if (at.mode == static_cast<int>(ContactMode::rolls)) {
      slips(slip / size.way);
      beyond_cone((at.friction.norm() - law.holding() * held) / size.force);
    } else {  // by |s|, so that a slip without a direction has none
      off_rim((slip * at.friction + mu * held * at.slip).norm() / (size.force * size.way));
    }
  }
  void report(LawReport& to) const {
    to.push_back({"gaps of contacts are not negative", penetrates.value, kOfRun});
    to.push_back({"an open contact has no reaction", open_pulls.value, algebraic});
    to.push_back({"the gap of a closed contact is 0", parts.value, kOfRun});
    to.push_back({"a contact that rolls has no slip", slips.value, kOfRun});
    to.push_back({"reactions are in the cone of friction", beyond_cone.value, kOfRun});
    to.push_back({"a contact that slides is on its rim, against the slip", off_rim.value, kOfRun});
    to.push_back({"friction does no work on a body", works.value, kOfRun});
  }
};

// At every node.
Simulation checked(const Simulation& simulation) {
  Config config = simulation.config();
  if (config.leaves_method()) config.rtol = 1e-10;
  config.output_times.clear();
  config.output_step.reset();
  config.every = 1;
  Simulation out = simulation;
  return out.config(std::move(config));
}

}  // namespace
}  // namespace check

LawReport check_contacts(const Simulation& simulation) {
  using namespace check;
  const Simulation followed = checked(simulation);
  const Result result = followed.run();
  if (!result) return {{"the run ends: " + result.status.reason, 1, 0}};
  const std::vector<ContactLaw>& laws = result.system->contact_laws;
  if (laws.empty()) return {{"the system has contacts with friction", 1, 0}};
  const Run run = followed.build();
  ContactNodes nodes(result, run);
  std::vector<ContactSizes> sizes(laws.size());
  double force = 0, way = 0;
  nodes.each([&](size_t c, const ContactNode& at) {
    sizes[c].way = std::max(sizes[c].way, at.way);
    sizes[c].force = std::max(sizes[c].force, std::abs(at.normal) + at.friction.norm());
    force = std::max(force, sizes[c].force);
    way = std::max(way, sizes[c].way);
  });
  const double time = std::abs(result.last.time - result.config.from);
  for (size_t c = 0; c < sizes.size(); ++c) {
    ContactSizes& size = sizes[c];
    if (!(size.force > 0)) size.force = force > 0 ? force : 1;
    size.way = std::max(size.way, kOfForce * size.force * nodes.reach(c) * time);
    if (!(size.way > 0)) size.way = way > 0 ? way : 1;
  }
  ContactViolations all;
  nodes.each([&](size_t c, const ContactNode& at) { all.take(laws[c], at, sizes[c], time); });
  LawReport out;
  all.report(out);
  out.push_back({"the balance of energy holds", std::abs(result.energy_error_max), kOfBalance});
  return out;
}

}  // namespace hamel
