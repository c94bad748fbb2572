// A study from its beginning to its end: checked, resumed, run, compared.
#include <algorithm>
#include <chrono>
#include <memory>

#include <hamel/framework/batch/shards.hpp>
#include <hamel/framework/study/parts.hpp>
#include <hamel/framework/study/runner.hpp>

namespace hamel {
namespace {
using Clock = std::chrono::steady_clock;
}

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
Study& Study::shard(Shard part) {
  shard_ = checked(part);
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

StudyResult Study::begun(Shard part) const {
  StudyResult out;
  out.config = config_;
  out.cells = cells_;
  out.shard = part;
  out.threads = threads_or_cores(threads_);
  out.metrics.resize(cells_.size());
  out.references.resize(config_.systems.size());
  return out;
}

bool StudyResult::runs(size_t cell) const {
  const auto all = static_cast<long>(cells.size()), i = static_cast<long>(cell);
  return cells[cell].runs() && first_piece(shard, all) <= i &&
         i < first_piece({shard.index + 1, shard.count}, all);
}

// Times that are not there are pending; what a session before has done.
void Study::begin_metrics(StudyResult& result) const {
  for (StudyMetrics& m : result.metrics) {
    if (m.done) ++result.resumed;
    m.nanoseconds.resize(static_cast<size_t>(config_.repeats), study::kPending);
  }
}

void Study::compare(StudyResult& result) const {
  std::vector<std::vector<bool>> angles;
  for (const StudySystem& system : config_.systems)
    angles.push_back(study::angle_columns(study::model(*registry_, system).group));
  study::compare(config_, cells_, angles, result.references, result.metrics);
}

StudyResult Study::run() const {
  const auto begin = Clock::now();
  if (shard_.count > 1 && folder_.empty())
    throw ConfigError({"shard: a part needs a folder for its journal"});
  StudyResult result = begun(shard_);
  std::unique_ptr<study::Journal> journal;
  if (!folder_.empty()) {
    journal = std::make_unique<study::Journal>(folder_, config_, shard_, fresh_);
    result.notes = journal->read(study::shapes(*registry_, config_), result);
  }
  begin_metrics(result);
  study::Runner runner(*registry_, result, journal.get(), progress_, stop_);
  runner.run();
  result.complete = runner.complete();
  compare(result);
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

StudyResult Study::merge() const {
  const auto begin = Clock::now();
  const long count = shards_in(folder_);
  StudyResult result = begun({1, 1});
  result.notes = study::join(folder_, count, study::shapes(*registry_, config_), result);
  begin_metrics(result);
  result.resumed = 0;
  result.complete = true;
  result.shards = count;
  compare(result);
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

}  // namespace hamel
