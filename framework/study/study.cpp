// A study from its beginning to its end: checked, then run or joined by the engine.
#include <hamel/framework/study/study.hpp>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/batch/shards.hpp>
#include <hamel/framework/io/errors.hpp>
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

// Nothing measured, and all times pending.
StudyResult Study::begun(Shard part) const {
  for (const StudySystem& system : config_.systems)
    if (system.model && !settings_.folder.empty())
      throw ConfigError({no_journal(settings_.folder, system.name)});
  StudyResult out;
  out.config = config_;
  out.cells = cells_;
  out.shard = part;
  StudyMetrics none;
  none.nanoseconds.resize(static_cast<size_t>(config_.repeats), study::kPending);
  out.metrics.resize(cells_.size(), none);
  out.references.resize(config_.systems.size());
  return out;
}

bool StudyResult::runs_in(const Shard& part, size_t cell) const {
  const auto all = static_cast<long>(cells.size()), i = static_cast<long>(cell);
  return cells[cell].runs() && first_piece(part, all) <= i && i < behind(part, all);
}

StudyResult Study::run() const {
  StudyResult out = begun(settings_.shard);
  study::Runner(*registry_, settings_, out).run();
  return out;
}

StudyResult Study::merge() const {
  StudyResult out = begun({});
  study::Runner(*registry_, settings_, out).merge();
  return out;
}

}  // namespace hamel
