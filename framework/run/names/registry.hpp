// The registry: groups, retractions, schemes, solvers, systems by name, and the compiled kernels.
//
// A registry is a plain value filled explicitly (systems/systems.cpp fills the library's own); a
// user's program adds to it with the add_... functions of systems/kernels.hpp, without touching the
// library.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/loop/lane_kernel.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// A retraction of one group.
struct RetractionInfo {
  std::string name, group, formula, domain;
  bool symmetric = false;
  bool one_parameter = false;
  std::shared_ptr<const Geometry> geometry;  // what erased problems evaluate
  /// The retraction of those factors of a product that have none of this name; empty: then it has
  /// none either.
  std::string elsewhere = {};
  std::string source = {};
};

using KernelFactory = std::function<std::unique_ptr<Kernel>(const KernelSetup&)>;

/// A scheme's descriptor (schemes/scheme.hpp), and its kernel for any problem.
struct SchemeInfo {
  std::string name, formula, source;
  bool adapted = true;
  bool uses_s = true;
  double fixed_s = 0;
  bool steps_admissible = true;
  bool left_invariant_only = false;
  bool explicit_step = false;
  bool estimates_error = false;
  bool varies_steps = false;
  bool places_forces = false;
  std::function<ClaimedOrder(double s, TauTraits tau, bool left_invariant)> claims;
  KernelFactory erased = {};

  bool defined(bool left_invariant) const { return left_invariant || !left_invariant_only; }
  /// Does a step need I on ker A only, not its inverse?
  bool takes_massless_links() const { return adapted && (steps_admissible || explicit_step); }
  /// The order claimed for a run; 0 where the scheme is not defined.
  ClaimedOrder claim(double s, TauTraits tau, bool left_invariant) const;
  /// Order on a system. With forces at the nodes only (lift), constant inertia and rows A xi = 0
  /// count as left-invariant: (M43).
  ClaimedOrder claim(double s, TauTraits tau, const Mechanics& system,
                     const std::string& force_at) const;
};

struct SolverInfo {
  std::string name, summary, source;
  /// Null for the solver that is compiled into the kernels.
  std::function<std::shared_ptr<Solver>()> make;
  std::string method = {};   // what an iteration does
  std::string stops = {};    // what ends a solve
  std::string package = {};  // the Debian package that brings it, where one is needed
};

/// A solver as one function: improves x, the guess, until |F(x)| <= tolerance. F is scaled; the
/// solve is judged by the best residual evaluated, without a report.
using SolveFunction =
    std::function<void(const Equation& equation, std::span<double> x, double tolerance)>;

/// A further TOML format for systems, recognised by its top-level keys.
struct FileKind {
  std::vector<std::string> keys;          // any of them; a file of this kind must have the first
  std::vector<std::string> options = {};  // accepted behind the name: my_robot.toml?hold=arm
  /// Throws ConfigError with every mistake, file, line and column.
  std::function<SystemModel(const std::string& text, const std::string& origin,
                            const Parameters& given, const NameOptions& options)>
      read = {};
};

/// A format of other programs, recognised by its extension: a text in it becomes one of our TOML
/// files.
struct FileFormat {
  std::string extension;             // ".urdf"
  std::vector<std::string> options;  // accepted behind the name: robot.urdf?wheel=left
  std::string package = {};          // the Debian package that a build without it lacks
  struct Converted {
    std::string toml;
    std::vector<std::string> notes = {};  // what the TOML leaves out
  };
  /// Null in a build without the package. Throws ConfigError with every mistake.
  std::function<Converted(const std::string& text, const std::string& path,
                          const NameOptions& options)>
      convert = {};
};

/// The key for which kernels are compiled: the type of a system (typeid of its Mechanics), or,
/// left-invariant, group and m.
std::string problem_key(const std::string& group, int m);
std::string problem_key(const std::type_info& mechanics);

/// Limit of products put together by name: a step takes n^3 operations and n^2 numbers.
constexpr int kMaxDimension = 1000;

class Registry {
 public:
  Registry();
  // Adding a name again replaces the earlier entry.
  void add(GroupInfo info);
  void add(RetractionInfo info);
  void add(SchemeInfo info);
  void add(SolverInfo info);
  void add(SystemInfo info);
  void add(FileKind kind);
  void add(FileFormat format);
  /// A system whose description is made when its name is first looked up: of files that go by name,
  /// listed apart.
  void add_deferred(const std::string& name, std::function<SystemInfo()> make);
  void add_solver(const std::string& name, const std::string& summary, SolveFunction solve);
  /// Another name of a scheme, accepted wherever a scheme is named; a scheme of that name goes
  /// first.
  void add_scheme_alias(const std::string& alias, const std::string& scheme);
  /// A solver that this build lacks because info.package is missing: listed and described, but no
  /// solver().
  void add_absent(SolverInfo info);
  /// A kernel compiled for one problem: problem_key() with a retraction and a scheme.
  void add_kernel(const std::string& problem, const std::string& retraction,
                  const std::string& scheme, KernelFactory factory);

  /// Adds the kernel of bodies in lanes.
  void add_lanes(const std::string& problem, const std::string& retraction,
                 const std::string& scheme, LaneInfo info);

  // Null when there is no such name.
  const GroupInfo* group(const std::string& name) const;
  const RetractionInfo* retraction(const std::string& group, const std::string& name) const;
  const SchemeInfo* scheme(const std::string& name) const;  // by its name or an alias
  const SolverInfo* solver(const std::string& name) const;
  const SolverInfo* absent_solver(const std::string& name) const;
  /// With options behind it where that system takes them: bicycle?hold=steer. ConfigError where
  /// they are no options.
  const SystemInfo* system(const std::string& name) const;
  /// The kernel compiled for this problem if there is one, else null: the scheme's erased one
  /// serves.
  const KernelFactory* kernel(const std::string& group, const Mechanics& mechanics,
                              const std::string& retraction, const std::string& scheme) const;
  /// The lanes compiled for this problem, else null.
  const LaneInfo* lanes(const std::string& group, const Mechanics& mechanics,
                        const std::string& retraction, const std::string& scheme) const;

  // Products written "se2*so2^3" that nobody registered are put together from their factors.
  /// Nothing when a factor is unknown, or the dimension above kMaxDimension.
  std::optional<GroupInfo> group_or_product(const std::string& name) const;
  /// Gives a model that has its group by name alone this group and its names; false where there is
  /// no such group.
  bool complete(SystemModel& model) const;
  /// The reason why there is no group or product of this name.
  std::string missing_group(const std::string& name) const;
  /// Null when a factor has no such retraction.
  std::shared_ptr<const Geometry> geometry(const std::string& group,
                                           const std::string& retraction) const;
  /// The retractions of a group, or those that all factors of a product offer.
  std::vector<std::string> retractions_or_common(const std::string& group) const;

  // Sorted names.
  std::vector<std::string> groups() const;
  std::vector<std::string> retractions() const;
  std::vector<std::string> retractions(const std::string& group) const;
  std::vector<std::string> schemes() const;  // without aliases
  std::vector<std::string> solvers() const;
  std::vector<std::string> absent_solvers() const;
  /// The reason why there is no solver of this name: a nearest name, or the package to install.
  std::string missing_solver(const std::string& name) const;
  std::vector<std::string> systems() const;
  /// The systems of add_deferred.
  std::vector<std::string> deferred_systems() const;
  /// Both: every name that system(name) accepts.
  std::vector<std::string> systems_and_files() const;
  const std::vector<FileKind>& file_kinds() const { return file_kinds_; }
  const std::vector<FileFormat>& file_formats() const { return file_formats_; }

  /// alias -> scheme.
  const std::map<std::string, std::string>& scheme_aliases() const { return scheme_aliases_; }

 private:
  std::map<std::string, GroupInfo> groups_;
  std::map<std::pair<std::string, std::string>, RetractionInfo> retractions_;  // (group, name)
  std::map<std::string, SchemeInfo> schemes_;
  std::map<std::string, std::string> scheme_aliases_;
  std::map<std::string, SolverInfo> solvers_, absent_solvers_;
  std::map<std::string, SystemInfo> systems_;
  struct Deferred;
  std::map<std::string, std::shared_ptr<Deferred>> deferred_;
  const SystemInfo* system_with_options(const std::string& name) const;
  struct WithOptions;
  std::shared_ptr<WithOptions> with_options_;  // systems whose names have options
  std::vector<FileKind> file_kinds_;
  std::vector<FileFormat> file_formats_;
  std::map<std::string, KernelFactory> kernels_;
  std::map<std::string, LaneInfo> lanes_;
};

}  // namespace hamel
