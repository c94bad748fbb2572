#include <hamel/systems/mechanisms/urdf.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/systems/mechanisms/urdf_wheels.hpp>

namespace hamel {
namespace {

using namespace mechanisms;

std::string spelled(double x) { return fmt::format("{}", x + 0.0); }  // no -0
std::string spelled(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", spelled(v[0]), spelled(v[1]), spelled(v[2]));
}

class Writer {
 public:
  Writer(Robot robot, std::string path, const FileOptions& options)
      : robot_(std::move(robot)), links_(robot_.links), path_(std::move(path)), options_(options) {}

  FileFormat::Converted convert() {
    find_root();
    check_masses();
    wheels_ = find_wheels(robot_, values_of("wheel"), path_, mistakes_);
    if (!mistakes_.empty()) throw ConfigError(mistakes_);
    raise();
    write_bodies();
    if (bodies_.empty())
      throw ConfigError(
          {path_ + ": nothing moves: its link 'world' is the ground, and it has no other"});
    write_joints();
    FileFormat::Converted out;
    out.toml = fmt::format("# Of {}, written by hamel.\nname = {}\nredundant = \"drop\"\n",
                           toml_string(path_), toml_string(robot_.name));
    table("body", bodies_, out.toml);
    table("joint", joints_, out.toml);
    write_wheels(out.toml);
    table("motor", motors_, out.toml);
    for (const std::string& note : notes()) {
      out.toml += "# " + note + "\n";
      out.notes.push_back(path_ + ": " + note);
    }
    return out;
  }

 private:
  void wrong(const std::string& what) { mistakes_.push_back(path_ + ": " + what); }
  std::vector<std::string> values_of(const std::string& option) const {
    const auto it = options_.find(option);
    return it == options_.end() ? std::vector<std::string>() : it->second;
  }
  RobotLink& link(int i) { return links_[static_cast<size_t>(i)]; }
  int count() const { return static_cast<int>(links_.size()); }

  void find_root() {
    const std::vector<std::string> given = values_of("root");
    const bool of_world = links_.front().name == "world";
    if (of_world) root_ = "world";
    if (given.empty()) return;
    const std::vector<std::string> known = {"planar", "free", "fixed"};
    if (of_world)
      wrong(fmt::format("root: got '{}', but its root link 'world' is the ground", given.back()));
    else if (std::ranges::find(known, given.back()) == known.end())
      wrong(unknown_name("root", given.back(), known));
    root_ = given.back();
  }

  // Refuses joints that move no mass.
  void check_masses() {
    std::vector<double> carried(links_.size());
    for (int i = count() - 1; i >= 0; --i) {
      const RobotLink& l = link(i);
      carried[static_cast<size_t>(i)] += l.mass;
      if (l.parent >= 0) carried[static_cast<size_t>(l.parent)] += carried[static_cast<size_t>(i)];
      const bool moves = i == 0 ? root_ == "planar" || root_ == "free" : l.joint.moves();
      if (!moves || carried[static_cast<size_t>(i)] > 0) continue;
      wrong(
          fmt::format("link '{}': it and all that it carries have no mass: give it an <inertial> "
                      "with mass and inertia{}",
                      l.name, i == 0 ? "" : ", or make joint '" + l.joint.name + "' fixed"));
    }
  }

  // The ground at the lowest wheel.
  void raise() {
    double lowest = 0;
    for (size_t i = 0; i < wheels_.size(); ++i)
      lowest = i == 0 ? wheels_[i].lowest() : std::min(lowest, wheels_[i].lowest());
    const Vec3 up = -lowest * Vec3::UnitZ();
    for (RobotLink& l : links_) {
      l.joint.at += up;
      l.centre += up;
      for (auto* shapes : {&l.visuals, &l.collisions})
        for (RobotShape& shape : *shapes) shape.pose.position += up;
    }
    for (RobotWheel& wheel : wheels_) wheel.centre += up;
    root_at_ = up;
  }

  // ---- bodies -------------------------------------------------------------------------------

  static bool is_frame(const RobotLink& l) {
    return l.mass == 0 && l.inertia.isZero(0) && l.visuals.empty() && l.collisions.empty();
  }
  // The body of a link; of a frame, without mass and shape, the one that it is welded to.
  void find_bodies() {
    bodies_of_.resize(links_.size());
    for (int i = 0; i < count(); ++i) bodies_of_[static_cast<size_t>(i)] = i;
    for (int i = count() - 1; i > 0; --i) {  // the first body that is welded to a frame
      const int parent = link(i).parent, body = bodies_of_[static_cast<size_t>(i)];
      if (parent == 0 && root_ == "world") continue;  // which is the ground
      if (!link(i).joint.moves() && is_frame(link(parent)) && !is_frame(link(body)))
        bodies_of_[static_cast<size_t>(parent)] = body;
    }
    for (int i = 1; i < count(); ++i)
      if (!link(i).joint.moves() && is_frame(link(bodies_of_[static_cast<size_t>(i)])))
        bodies_of_[static_cast<size_t>(i)] = bodies_of_[static_cast<size_t>(link(i).parent)];
  }
  std::string name_of(int i) const {
    const int body = bodies_of_[static_cast<size_t>(i)];
    const bool ground = body == 0 && root_ == "world";
    return toml_string(ground ? "ground" : links_[static_cast<size_t>(body)].name);
  }
  // A name that no body has yet: this one, or with bars behind it.
  std::string unused(std::string name) {
    while (!taken_.insert(name).second) name += "_";
    return name;
  }
  // "ground" is what rests in the world, and a link of this name is a body as others are.
  void name_bodies() {
    taken_.insert("ground");
    for (const RobotLink& l : links_)
      if (l.name != "ground") taken_.insert(l.name);
    for (RobotLink& l : links_) {
      if (l.name != "ground") continue;
      l.name = unused(l.name);
      renamed_.push_back(l.name);
    }
  }

  // A box along the axes of the pose, a cylinder or a sphere as a body has it; "" for others.
  std::string words_of(const RobotShape& shape, const RobotLink& l) {
    using Kind = RobotShape::Kind;
    if (shape.kind == Kind::sphere) return ", sphere = " + spelled(shape.radius());
    if (shape.kind == Kind::cylinder)
      return fmt::format(", cylinder = [{}, {}], axis = {}", spelled(shape.size[0]),
                         spelled(shape.size[1]), spelled(shape.axis()));
    if (shape.kind == Kind::mesh) return "";
    const Mat<3, 3> turned = shape.pose.rotation.cwiseAbs();
    const Mat<3, 3> near = turned.array().round();
    if ((turned - near).isZero(1e-9)) return ", box = " + spelled(Vec3(near * shape.size));
    turned_.push_back(l.name);
    return "";
  }

  // The visuals; where all of them are meshes, the collisions.
  const std::vector<RobotShape>& drawn_shapes(const RobotLink& l) {
    const auto mesh = [](const RobotShape& s) { return s.kind == RobotShape::Kind::mesh; };
    if (std::ranges::any_of(l.visuals, mesh)) undrawn_.push_back(l.name);
    return std::ranges::all_of(l.visuals, mesh) ? l.collisions : l.visuals;
  }

  void write_bodies() {
    find_bodies();
    name_bodies();
    for (int i = 0; i < count(); ++i) {
      if (bodies_of_[static_cast<size_t>(i)] != i || (i == 0 && root_ == "world")) continue;
      const RobotLink& l = link(i);
      std::string body = fmt::format("name = {}, mass = {}, at = {}", toml_string(l.name),
                                     spelled(l.mass), spelled(l.centre));
      if (l.mass > 0 || !l.inertia.isZero(0)) {
        const Mat<3, 3>& m = l.inertia;
        body +=
            fmt::format(", inertia = [{}, {}, {}, {}, {}, {}]", spelled(m(0, 0)), spelled(m(0, 1)),
                        spelled(m(0, 2)), spelled(m(1, 1)), spelled(m(1, 2)), spelled(m(2, 2)));
      }
      bool drawn = false;
      std::vector<std::string> others;
      for (const RobotShape& shape : drawn_shapes(l)) {
        const std::string words = words_of(shape, l);
        if (words.empty()) continue;
        if (!drawn && (shape.pose.position - l.centre).isZero(1e-12)) {
          body += words;
          drawn = true;
        } else {
          others.push_back(fmt::format("mass = 0, at = {}{}", spelled(shape.pose.position), words));
        }
      }
      bodies_.push_back(body);
      for (size_t k = 0; k < others.size(); ++k) {
        const std::string name = toml_string(unused(fmt::format("{} shape {}", l.name, k + 1)));
        bodies_.push_back(fmt::format("name = {}, {}", name, others[k]));
        welds_.push_back(fmt::format("name = {0}, kind = \"weld\", parent = {1}, child = {0}", name,
                                     toml_string(l.name)));
      }
    }
  }

  // ---- joints -------------------------------------------------------------------------------

  void write_joints() {
    if (root_ != "world") {
      std::string name = "root";
      while (std::ranges::any_of(links_, [&](const RobotLink& l) { return l.joint.name == name; }))
        name += "_";
      joints_.push_back(fmt::format("name = {}, kind = \"{}\", child = {}, at = {}",
                                    toml_string(name), root_ == "fixed" ? "weld" : root_,
                                    name_of(0), spelled(root_at_)));
    }
    for (int i = 1; i < count(); ++i) {
      const RobotJoint& joint = link(i).joint;
      const std::string parent = name_of(link(i).parent), child = name_of(i);
      if (parent == child) continue;
      std::string line =
          fmt::format("name = {}, kind = \"{}\", parent = {}, child = {}, at = {}",
                      toml_string(joint.name), joint.kind, parent, child, spelled(joint.at));
      if (joint.moves() && joint.kind != "free") line += ", axis = " + spelled(joint.axis);
      if (joint.damping != 0) line += ", damping = " + spelled(joint.damping);
      joints_.push_back(line);
      if (joint.kind == "hinge" || joint.kind == "slider") add_motor(joint);
    }
    joints_.insert(joints_.end(), welds_.begin(), welds_.end());
  }
  void add_motor(const RobotJoint& joint) {
    if (joint.effort && !(*joint.effort > 0)) return;
    if (motors_.size() >= static_cast<size_t>(kMostInputs)) return unmotored_.push_back(joint.name);
    std::string line = "joint = " + toml_string(joint.name);
    if (joint.effort)
      line +=
          fmt::format(", least = {}, most = {}", spelled(-*joint.effort), spelled(*joint.effort));
    motors_.push_back(line);
  }

  void write_wheels(std::string& out) {
    std::vector<std::string> wheels, balls;
    for (const RobotWheel& w : wheels_) {
      std::string line = fmt::format("body = {}, at = {}, radius = {}", name_of(w.link),
                                     spelled(w.centre), spelled(w.radius));
      if (!w.ball) line += ", axle = " + spelled(w.axle);
      (w.ball ? balls : wheels).push_back(line);
    }
    table("wheel", wheels, out);
    table("ball", balls, out);
  }
  static void table(const std::string& kind, const std::vector<std::string>& entries,
                    std::string& out) {
    if (entries.empty()) return;
    out += kind + " = [\n";
    for (const std::string& entry : entries) out += "  { " + entry + " },\n";
    out += "]\n";
  }

  // Notes on what the mechanism leaves out.
  std::vector<std::string> notes() const {
    std::vector<std::string> out;
    const auto note = [&](const std::string& what, const std::vector<std::string>& names) {
      std::vector<std::string> quoted;
      for (const std::string& name : names) quoted.push_back(toml_string(name));
      if (!names.empty()) out.push_back(fmt::format("{}: {}", what, fmt::join(quoted, ", ")));
    };
    if (wheels_.empty() && root_ == "planar")
      note("no --wheel is given: nothing rolls on the ground, and the root slides on it freely",
           {links_.front().name});
    std::vector<std::string> limited, friction;
    for (const RobotLink& l : links_) {
      if (l.joint.limited) limited.push_back(l.joint.name);
      if (l.joint.friction) friction.push_back(l.joint.name);
    }
    note("limits of position and velocity are not kept", limited);
    note("friction is left out, damping is kept", friction);
    note("a link 'ground' goes by another name, as the ground has this one", renamed_);
    note(fmt::format("no motor, at most {} inputs", kMostInputs), unmotored_);
    note("angles within 0.002 rad of a right angle are taken as that", robot_.rounded);
    note("meshes are not drawn", undrawn_);
    note("boxes that are turned against the axes are not drawn", turned_);
    return out;
  }

  Robot robot_;
  std::vector<RobotLink>& links_;
  std::string path_;
  const FileOptions& options_;
  std::string root_ = "planar";  // "world": the root link is the ground
  Vec3 root_at_ = Vec3::Zero();
  std::vector<RobotWheel> wheels_;
  std::vector<int> bodies_of_;
  std::set<std::string> taken_;
  std::vector<std::string> renamed_, bodies_, joints_, welds_, motors_, undrawn_, turned_,
      unmotored_, mistakes_;
};

}  // namespace

FileFormat urdf_format() {
  FileFormat out{".urdf", {"root", "wheel"}, "liburdfdom-dev"};
#ifdef HAMEL_HAS_URDFDOM
  out.convert = [](const std::string& text, const std::string& path, const FileOptions& options) {
    return Writer(read_robot(text, path), path, options).convert();
  };
#endif
  return out;
}

}  // namespace hamel
