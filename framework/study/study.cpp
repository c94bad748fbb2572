// A study from its beginning to its end: checked, resumed, run, compared.
#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include <hamel/framework/study/parts.hpp>
#include <hamel/framework/study/runner.hpp>

namespace hamel {

Study::Study(const Registry& registry, StudyConfig config)
    : registry_(&registry), config_(std::move(config)) {
  study::read_data(config_);
  const std::vector<std::string> mistakes = config_.mistakes(registry);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  cells_ = study_cells(config_, registry);
}

Study& Study::threads(int count) {
  threads_ = count;
  return *this;
}
Study& Study::folder(std::string path) {
  folder_ = std::move(path);
  return *this;
}
Study& Study::fresh(bool forget) {
  fresh_ = forget;
  return *this;
}
Study& Study::progress(std::function<void(double)> report) {
  progress_ = std::move(report);
  return *this;
}
Study& Study::stop(const std::atomic<bool>* flag) {
  stop_ = flag;
  return *this;
}

StudyResult Study::run() const {
  const auto begin = std::chrono::steady_clock::now();
  StudyResult result;
  result.config = config_;
  result.cells = cells_;
  result.threads =
      threads_ > 0 ? threads_ : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  result.metrics.resize(cells_.size());
  result.references.resize(config_.systems.size());
  std::unique_ptr<study::Journal> journal;
  if (!folder_.empty()) {
    journal = std::make_unique<study::Journal>(folder_, config_, fresh_);
    result.notes = study::read_lines(journal->lines(), study::shapes(*registry_, config_), result);
  }
  for (StudyMetrics& m : result.metrics) {
    if (m.done) ++result.resumed;
    m.nanoseconds.resize(static_cast<size_t>(config_.repeats), study::kPending);
  }
  study::Runner runner(*registry_, result, journal.get(), progress_, stop_);
  runner.run();
  result.complete = runner.complete();
  study::compare(config_, cells_, result.references, result.metrics);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace hamel
