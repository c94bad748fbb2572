// Pages of three results, each an HTML file that any browser opens from disk: a run of the falling
// disk, a study of two schemes at three steps, and an ensemble of rattlebacks that are spun either
// way.
#include <filesystem>
#include <iostream>

#include <hamel/simulate.hpp>

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "report_pages";
  std::filesystem::create_directories(folder);
  const auto file = [&](const char* name) { return (folder / name).string(); };

  const auto run = hamel::simulate("falling_disk").step(0.01).until(5).run();
  hamel::write_page(hamel::registry(), run, file("run.html"));

  hamel::StudyConfig study;
  study.title = "Two schemes on Suslov's problem";
  study.systems = {{.label = "suslov", .name = "suslov"}};
  study.axes = {{"scheme", {"lift", "rkmk4"}}, {"step", {0.1, 0.05, 0.025}}};
  study.until = 5;
  study.repeats = 1;
  const auto cells = hamel::Study(hamel::registry(), study).run();
  hamel::write_page(cells, file("study.html"));

  hamel::EnsembleConfig ensemble;
  ensemble.run.system = "rattleback";
  ensemble.run.step = 0.01;
  ensemble.run.until = 5;
  ensemble.vary = {{"start.omega3", hamel::Variation::Law::values, {-4, -2, 2, 4}}};
  ensemble.keep = {{"spin", "end.omega3"}};
  ensemble.classes = {"end.omega3 > 0 ? 1 : 0", {"clockwise", "anticlockwise"}};
  const auto members = hamel::Ensemble(hamel::registry(), ensemble).threads(2).run();
  hamel::write_page(hamel::registry(), members, file("ensemble.html"));

  std::cout << folder.string() << "/run.html, study.html, ensemble.html\n";
  return run ? 0 : 1;
} catch (const hamel::ConfigError& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
