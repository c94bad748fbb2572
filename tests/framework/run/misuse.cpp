// Misuse of a run from C++: each ends in std::logic_error by name where it can be seen, or in a
// Status with the reason, and never in a crash or a loop without end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <thread>

#include <hamel/simulate.hpp>

namespace hamel {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

/// The text of a std::logic_error; "nothing was thrown" without one.
std::string misuse(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

Simulation sleigh() { return simulate("chaplygin_sleigh").step(0.01).until(1); }

using Act = std::function<void(std::optional<hamel::Run>&)>;
struct Named {
  const char* name;
  Act act;
};

// Members that change a run.
std::vector<Named> changes() {
  return {{"step", [](auto& run) { (void)run->step(); }},
          {"step_towards", [](auto& run) { (void)run->step_towards(1); }},
          {"advance_to", [](auto& run) { (void)run->advance_to(1); }},
          {"complete", [](auto& run) { (void)run->complete(); }},
          {"turn_back", [](auto& run) { run->turn_back(); }},
          {"restart", [](auto& run) { run->restart(run->config().start); }},
          {"finish", [](auto& run) { (void)run->finish(); }}};
}
std::vector<Named> readings() {
  return {{"state", [](auto& run) { (void)run->state(); }},
          {"at", [](auto& run) { (void)run->at(run->time()); }},
          {"time", [](auto& run) { (void)run->time(); }},
          {"events", [](auto& run) { (void)run->events(); }},
          {"stats", [](auto& run) { (void)run->stats(); }}};
}

/// The three kinds of functions that a run calls, each of which acts on the run itself.
std::vector<Simulation> calling(const std::function<void()>& act) {
  return {sleigh().observe([act](const Snapshot&) {
            act();
            return true;
          }),
          sleigh().on_event("theta=0.05", [act](EventState&) { act(); }),
          sleigh().progress([act](double) { act(); })};
}

TEST(Misuse, ByItsOwnFunctions) {
  std::optional<hamel::Run> run;
  for (const auto& [name, change] : changes()) {
    const auto& act = change;  // a lambda of clang 14 captures no structured binding
    for (const Simulation& made : calling([&run, &act] { act(run); })) {
      run.emplace(made.build());
      EXPECT_THAT(misuse([&] { (void)run->complete(); }),
                  HasSubstr("Run::" + std::string(name) + ": called by one of its own functions"));
    }
  }
  for (const auto& [name, reading] : readings()) {
    const auto& act = reading;
    for (const Simulation& made : calling([&run, &act] { act(run); })) {
      run.emplace(made.build());
      EXPECT_TRUE(run->complete()) << name;
    }
  }
}

/// A run that is moved, replaced or destroyed while it steps lives until the step is over.
TEST(Misuse, GoneDuringAStep) {
  std::optional<hamel::Run> run, other;
  const std::vector<std::function<void()>> acts = {
      [&] { other.emplace(std::move(*run)); }, [&] { run.reset(); },
      [&] { *run = sleigh().build(); }, [&] { const hamel::Run gone = std::move(*run); }};
  for (const auto& act : acts) {
    for (const Simulation& made : calling([&] {
           if (run) act();
         })) {
      run.emplace(made.build());
      EXPECT_THAT(misuse([&] { (void)run->complete(); }),
                  AnyOf(HasSubstr("moved or destroyed it during a step")));
      other.reset();
    }
  }
}

TEST(Misuse, MovedFrom) {
  std::vector<Named> all = changes();
  for (Named& one : readings()) all.push_back(std::move(one));
  all.push_back({"input", [](auto& run) { run->input("torque", 1); }});
  std::optional<hamel::Run> run = sleigh().build();
  const hamel::Run elsewhere = std::move(*run);
  for (const auto& [name, act] : all) {
    EXPECT_THAT(misuse([&run, &act = act] { act(run); }), HasSubstr("this run was moved from"));
  }
  *run = sleigh().build();
  EXPECT_TRUE(run->step());
}

TEST(Misuse, OfAResult) {
  Result none;
  Result moved = sleigh().run();
  const Result kept = std::move(moved);
  EXPECT_THAT(kept.report(), HasSubstr("chaplygin_sleigh"));
  for (const Result* result : {&none, &moved}) {
    EXPECT_THAT(misuse([&] { (void)result->report(); }),
                HasSubstr("Result::report: this result is of no run"));
    EXPECT_THAT(misuse([&] { (void)result->record(); }), HasSubstr("Result::record"));
    EXPECT_THAT(misuse([&] { result->write("x.json"); }), HasSubstr("Result::write"));
  }
}

TEST(Misuse, BehindItsEnd) {
  hamel::Run run = sleigh().stop_at({"theta=0.1"}).keep_rows(100).build();
  (void)run.complete();
  const Result result = run.finish();
  EXPECT_GT(result.trajectory.rows(), 2u);
  for (const Status& status :
       {run.step(), run.step_towards(5), run.advance_to(5), run.complete()}) {
    EXPECT_FALSE(status.ok);
    EXPECT_THAT(status.reason, HasSubstr("this run is finished"));
  }
  EXPECT_THAT(misuse([&] { (void)run.finish(); }), HasSubstr("Run::finish: this run is finished"));
  EXPECT_EQ(run.state().coordinates, result.last.coordinates);
  ASSERT_EQ(run.events().size(), 1u);
  run.restart(run.config().start);
  EXPECT_TRUE(run.step());
  EXPECT_GT(run.state().time, 0);
}

TEST(Misuse, TimesThatAreNone) {
  for (Simulation made : {sleigh(), simulate("suslov").scheme("dop853").tolerance({1e-8})}) {
    hamel::Run run = made.build();
    for (const double t : {std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), std::nan("")}) {
      for (const Status& status : {run.advance_to(t), run.step_towards(t)}) {
        EXPECT_FALSE(status.ok);
        EXPECT_THAT(status.reason, HasSubstr("expected a finite time"));
      }
    }
    EXPECT_EQ(run.time(), 0);
    EXPECT_TRUE(run.step());
  }
}

/// One thread is within a step, held there by the observer, when the other comes.
TEST(Misuse, TwoThreads) {
  std::optional<hamel::Run> run;
  std::vector<Named> all = changes();
  for (Named& one : readings()) all.push_back(std::move(one));
  for (const auto& [name, act] : all) {
    std::atomic<bool> inside = false, done = false;
    run.emplace(sleigh()
                    .observe([&](const Snapshot&) {
                      inside = true;
                      while (!done) std::this_thread::yield();
                      return false;
                    })
                    .build());
    std::thread first([&] { (void)run->step(); });
    while (!inside) std::this_thread::yield();
    EXPECT_THAT(misuse([&run, &act = act] { act(run); }), HasSubstr("two threads use this run"))
        << name;
    done = true;
    first.join();
  }
}

/// Random acts on runs by random functions, some of them allowed and some not: none crashes.
TEST(Misuse, AtRandom) {
  std::mt19937 random(7);
  const auto below = [&](size_t n) { return random() % n; };
  std::vector<Named> all = changes();
  for (Named& one : readings()) all.push_back(std::move(one));
  all.push_back({"reset", [](auto& run) { run.reset(); }});
  all.push_back({"move", [](auto& run) { const hamel::Run gone = std::move(*run); }});
  all.push_back({"replace", [](auto& run) { *run = sleigh().build(); }});
  int refused = 0;
  for (int k = 0; k < 300; ++k) {
    std::optional<hamel::Run> run;
    const auto act = [&] {
      if (run && below(20) == 0) all[below(all.size())].act(run);
    };
    run.emplace(calling(act)[below(3)].build());
    for (int i = 0; i < 20 && run; ++i)
      refused += misuse([&] { all[below(all.size())].act(run); }) != "nothing was thrown" ? 1 : 0;
  }
  EXPECT_GT(refused, 50);
}

/// Rows that a run by hand does not keep are none that it could lack room for.
TEST(Misuse, RowsThatAreNotKept) {
  const Simulation fine = simulate("suslov").step(1e-9).until(1e6);
  EXPECT_THAT(fine.mistakes(), testing::Contains(HasSubstr("rows would be recorded")));
  hamel::Run run = fine.build();
  EXPECT_TRUE(run.step(10));
  EXPECT_THAT(misuse([&] { (void)Simulation(fine).keep_rows(10).build(); }), HasSubstr("nothing"));
  EXPECT_THROW((void)Simulation(fine).observe([](const Snapshot&) { return true; }).build(),
               ConfigError);
}

}  // namespace
}  // namespace hamel
