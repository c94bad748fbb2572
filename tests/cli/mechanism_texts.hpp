// Pieces of mechanism files, and files that are refused.
#pragma once

#include <string>
#include <vector>

#include "program.hpp"

namespace hamel::test {

struct Mistake {
  std::string text, message;  // behind "system.toml:"
};

// A body on the plane: eight lines. A body in space with its mass centre at 0.3 m: nine.
inline const std::string kFlat = R"([[body]]
name = "a"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "floor"
kind = "planar"
child = "a"
)";
inline const std::string kSpace = R"([[body]]
name = "a"
mass = 1
at = [0, 0, 0.3]
inertia = [1, 1, 1]
[[joint]]
kind = "free"
child = "a"
at = [0, 0, 0.3]
)";
// Behind kFlat, to line 18: a second body on a hinge.
inline const std::string kArm = R"([[body]]
name = "b"
mass = 1
at = [1, 0, 0]
inertia = [1, 1, 1]
[[joint]]
name = "arm"
kind = "hinge"
parent = "a"
child = "b"
)";
// A crank and a rod, in the plane of x and z: 22 lines.
inline const std::string kCrank = R"([[body]]
name = "crank"
mass = 1
at = [0, 0, 0.5]
inertia = [1, 1, 1]
[[body]]
name = "rod"
mass = 1
at = [0.5, 0, 1]
inertia = [1, 1, 1]
[[joint]]
name = "low"
kind = "hinge"
child = "crank"
axis = [0, 1, 0]
[[joint]]
name = "high"
kind = "hinge"
parent = "crank"
child = "rod"
at = [0, 0, 1]
axis = [0, 1, 0]
)";

class MechanismMistakes : public CommandLine {
 protected:
  void refuses(const std::vector<Mistake>& mistakes) const {
    for (const auto& [text, message] : mistakes) {
      const std::string path = write(text);
      for (const char* command : {"run", "describe"}) {
        const Outcome o = run({command, path});
        EXPECT_EQ(o.status, 2) << text;
        EXPECT_THAT(o.err, testing::HasSubstr("system.toml:" + message)) << text;
      }
    }
  }
};

}  // namespace hamel::test
