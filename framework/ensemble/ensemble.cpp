// An ensemble from its beginning to its end: checked, then run or joined by the engine.
#include <hamel/framework/ensemble/ensemble.hpp>

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/batch/engine.hpp>
#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/ensemble/collector.hpp>
#include <hamel/framework/ensemble/lane_members.hpp>

namespace hamel {
namespace {

using ensemble::Collector;
using ensemble::kPiece;

// The first member of a shard, and the first one behind it.
long first_of(const Shard& part, long members) {
  return std::min(members, kPiece * first_piece(part, ensemble::pieces_of(members)));
}
long end_of(const Shard& part, long members) {
  return std::min(members, kPiece * behind(part, ensemble::pieces_of(members)));
}

// An ensemble as pieces of the engine: 16 members each, a line of the journal.
class Session : public Engine {
 public:
  Session(const Registry& registry, const EnsembleConfig& config, const BatchSettings& settings,
          const Shard& part, bool lanes, EnsembleResult& result)
      : Engine(settings, result),
        config_(config),
        plan_(registry, config_),
        result_(begun(result, config, part)),
        collector_(plan_, result),
        lanes_(lanes) {
    if (lanes && !plan_.alone.empty()) result.notes.push_back(plan_.alone);
  }

 private:
  static EnsembleResult& begun(EnsembleResult& out, const EnsembleConfig& config,
                               const Shard& part) {
    out.config = config;
    out.shard = part;
    out.first = first_of(part, config.members);
    out.members = end_of(part, config.members) - out.first;
    return out;
  }

  JournalSubject subject() const override {
    return {"ensemble", "members", result_.config.fingerprint()};
  }
  void take(const std::string& line) override { collector_.take(ensemble::piece_of(line)); }
  std::string lacks(const Shard& part) const override {
    const long all = config_.members, first = first_of(part, all), end = end_of(part, all);
    long done = 0;
    for (long at = first; at < end; at += kPiece)
      if (collector_.has(at / kPiece)) done += std::min(kPiece, end - at);
    return done == end - first ? "" : fmt::format("{} of {} members", done, end - first);
  }
  Pieces pieces() const override {
    Pieces out;
    out.all = result_.members;
    out.resumed = static_cast<size_t>(result_.done);
    const long end = result_.first + result_.members;
    for (long at = result_.first; at < end; at += kPiece)
      if (!collector_.has(at / kPiece))
        out.left.push_back({static_cast<size_t>(at), std::min(kPiece, end - at)});
    return out;
  }
  Worker worker() override {
    const auto members = std::make_shared<ensemble::LaneMembers>(plan_, lanes_, stop());
    return [this, members](size_t first, const Counted&) {
      ensemble::Piece piece{static_cast<long>(first), {}, {}};
      const long count = std::min(kPiece, result_.first + result_.members - piece.first);
      piece.rows.resize(static_cast<size_t>(count) * plan_.kept->width());
      if (!members->run(piece.first, piece.rows, piece.failures)) return false;
      keep([&] { return ensemble::line_of(piece); });
      collector_.take(piece);
      return true;
    };
  }
  void finish() override { collector_.finish(); }

  EnsembleConfig config_;
  ensemble::Plan plan_;
  EnsembleResult& result_;
  Collector collector_;
  bool lanes_;
};

}  // namespace

Ensemble::Ensemble(const Registry& registry, EnsembleConfig config)
    : registry_(&registry), config_(std::move(config)) {
  ensemble::read_data(config_);
  ensemble::Plan(registry, config_);
}

Ensemble& Ensemble::lanes(bool use) {
  lanes_ = use;
  return *this;
}
void Ensemble::check_folder() const {
  if (config_.model && !settings_.folder.empty())
    throw ConfigError({no_journal(settings_.folder, config_.run.system)});
}

EnsembleResult Ensemble::run() const {
  check_folder();
  EnsembleResult out;
  Session(*registry_, config_, settings_, settings_.shard, lanes_, out).run();
  return out;
}

EnsembleResult Ensemble::merge() const {
  check_folder();
  EnsembleResult out;
  Session(*registry_, config_, settings_, {}, lanes_, out).merge();
  return out;
}

Member Ensemble::member(long index) const {
  if (index < 0 || index >= config_.members)
    throw ConfigError(
        {fmt::format("member: got {}, expected 0 to {}", index, config_.members - 1)});
  EnsembleConfig config = config_;
  const ensemble::Plan plan(*registry_, config);
  ensemble::MemberRunner runner(plan, settings_.stop);
  Member out;
  out.index = index;
  std::vector<double> row(plan.kept->width());
  runner.run(index, row, out.failure);
  out.failed = !out.failure.reason.empty();
  for (const size_t v : plan.variations->numbered())
    out.varied.emplace_back(plan.variations->all()[v].name, plan.variations->number(v, index));
  const size_t shown = plan.kept->kept() + (config.classes.names.empty() ? 0 : 1);
  for (size_t i = 0; i < shown; ++i) out.kept.emplace_back(plan.kept->columns()[i].name, row[i]);
  try {
    out.config = runner.config(index);
  } catch (const ConfigError&) {  // the reason of its failure
  }
  return out;
}

Simulation Ensemble::simulation(const Member& member) const {
  return ensemble::simulation(*registry_, config_, member.config);
}

}  // namespace hamel
