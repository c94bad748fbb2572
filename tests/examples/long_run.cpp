// A long run that loses nothing: written as it goes, stopped half way, gone on with. The end is the
// undisturbed run's.
#include <hamel/simulate.hpp>

#include <cstdio>
#include <iostream>
#include <stdexcept>

int main() {
  const auto disk = [](const char* file) {
    return hamel::simulate("rolling_disk").step(0.01).until(400).record_to(file);
  };
  std::remove("disk.h5.part");  // of an earlier time
  try {
    disk("disk.h5")
        .observe([](const hamel::Snapshot& state) {
          return state.time < 300 ? true : throw std::runtime_error("the lights went out");
        })
        .run();
  } catch (const std::runtime_error& error) {
    std::cout << error.what() << "; the rows so far are in disk.h5.part\n";
  }
  const hamel::Result whole = disk("whole.h5").run();
  const hamel::Result rest = disk("disk.h5").resume("disk.h5").run();  // from the last checkpoint
  std::cout << rest.report() << "rows in memory: " << rest.trajectory.rows() << "\n";
  return rest && rest.last.coordinates == whole.last.coordinates &&
                 rest.constraint_max == whole.constraint_max && rest.steps == whole.steps
             ? 0
             : 1;
}
