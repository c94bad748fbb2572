#include <hamel/framework/study/runner.hpp>

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/study/parts.hpp>

namespace hamel::study {

Runner::Runner(const Registry& registry, const BatchSettings& settings, StudyResult& result)
    : Engine(settings, result),
      registry_(registry),
      result_(result),
      shapes_(shapes(registry, result.config)) {}

size_t Runner::number_of(const Work& work) const {
  if (work.kind == Kind::reference) return work.index;
  const size_t round = work.kind == Kind::measure ? 0 : 1 + work.round;
  return result_.references.size() + round * result_.cells.size() + work.index;
}

Runner::Work Runner::work_of(size_t number) const {
  const size_t systems = result_.references.size(), cells = result_.cells.size();
  if (number < systems) return {Kind::reference, number};
  const size_t cell = (number - systems) % cells, round = (number - systems) / cells;
  if (round == 0) return {Kind::measure, cell};
  return {Kind::time, cell, round - 1};
}

JournalSubject Runner::subject() const {
  JournalSubject out{"study", "cells", {}};
  std::istringstream in(result_.config.fingerprint());
  for (std::string line; std::getline(in, line);) out.lines.push_back(line);
  return out;
}

void Runner::take(const std::string& line) { take_line(line, shapes_, result_); }

std::string Runner::lacks(const Shard& part) const {
  long done = 0, all = 0;
  for (size_t i = 0; i < result_.cells.size(); ++i) {
    if (!result_.runs_in(part, i)) continue;
    ++all;
    done += finished_cell(result_, i) ? 1 : 0;
  }
  return done == all ? "" : fmt::format("{} of {} cells", done, all);
}

// References, then cells, each after its reference, then timings.
Engine::Pieces Runner::pieces() const {
  Pieces out;
  const auto rounds = static_cast<size_t>(result_.config.repeats);
  std::vector<size_t> mine;
  for (size_t i = 0; i < result_.cells.size(); ++i)
    if (result_.runs(i)) mine.push_back(i);
  const auto add = [&](const Work& work, bool there, long steps, size_t after = kNone) {
    out.all += steps;
    if (!there) out.left.push_back({number_of(work), steps, after});
  };
  std::vector<char> used(result_.references.size());
  for (const size_t i : mine) used[result_.cells[i].system] = 1;
  std::vector<size_t> made(used.size(), kNone);  // where in the list
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    const bool there = !result_.references[i].times.empty();
    if (!there) made[i] = out.left.size();
    add({Kind::reference, i}, there,
        reference_steps(registry_, result_.config, result_.config.systems[i]));
  }
  std::vector<long> steps;
  for (const size_t i : mine) {
    steps.push_back(expected_steps(result_.cells[i].config()));
    const bool there = result_.metrics[i].done;
    out.resumed += there ? 1 : 0;
    add({Kind::measure, i}, there, steps.back(), made[result_.cells[i].system]);
  }
  for (size_t round = 0; round < rounds; ++round)
    for (size_t k = 0; k < mine.size(); ++k)
      add({Kind::time, mine[k], round}, result_.metrics[mine[k]].nanoseconds[round] != kPending,
          steps[k]);
  return out;
}

Engine::Worker Runner::worker() {
  return [this](size_t number, const Counted& counted) { return does(work_of(number), counted); };
}

bool Runner::does(const Work& work, const Counted& counted) {
  switch (work.kind) {
    case Kind::reference: return make_reference(work.index, counted);
    case Kind::measure: return measure(work.index);
    case Kind::time: return time(work.index, work.round);
  }
  return false;
}

bool Runner::make_reference(size_t system, const Counted& counted) {
  const auto cell = std::find_if(
      result_.cells.begin(), result_.cells.end(),
      [&](const StudyCell& candidate) { return candidate.runs() && candidate.system == system; });
  StudyReference made = study::reference(registry_, result_.config, result_.config.systems[system],
                                         cell->config(), counted, stop());
  if (made.times.empty()) return false;
  keep([&] { return line_of(system, made); });
  result_.references[system] = std::move(made);  // read by pieces that begin after this one
  return true;
}

bool Runner::measure(size_t cell) {
  const size_t system = result_.cells[cell].system;
  StudyMetrics measured = study::measure(registry_, result_.config.systems[system],
                                         result_.cells[cell], result_.references[system], stop());
  if (!measured.done) return false;
  keep([&] { return line_of(cell, measured); });
  const std::lock_guard lock(mutex_);  // the cell may be timed at the same time
  StudyMetrics& mine = result_.metrics[cell];
  measured.nanoseconds = std::move(mine.nanoseconds);
  mine = std::move(measured);
  return true;
}

bool Runner::time(size_t cell, size_t round) {
  const double ns = time_per_step(registry_, result_.config.systems[result_.cells[cell].system],
                                  result_.cells[cell], stop());
  if (stopped()) return false;
  keep([&] { return line_of(cell, round, ns); });
  const std::lock_guard lock(mutex_);
  result_.metrics[cell].nanoseconds[round] = ns;
  return true;
}

void Runner::finish() {
  std::vector<std::vector<bool>> angles;
  for (const StudySystem& system : result_.config.systems)
    angles.push_back(angle_columns(model(registry_, system).group));
  compare(result_.config, result_.cells, angles, result_.references, result_.metrics);
}

}  // namespace hamel::study
