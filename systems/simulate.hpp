// <hamel/simulate.hpp>: hamel by name. Runs, stepping by hand, events, inputs, files, mechanisms by
// parts, studies, ensembles, steady motions and sections, with standard-library types only: a
// program that includes this one compiles in a second, and cannot disagree with the library about
// alignment, flags or Eigen.
//
//   auto result =
//       hamel::simulate("kick_scooter").speed(2).scheme("lift").step(0.01).until(10).run();
//
// Own systems, groups, retractions and schemes, compiled in the program's types: <hamel/hamel.hpp>.
#pragma once

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/framework/analysis/linearisation.hpp>
#include <hamel/framework/analysis/section.hpp>
#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/inverse/fit.hpp>
#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/framework/pages/pages.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/study/study.hpp>
#include <hamel/framework/tangent/sensitivities.hpp>
#include <hamel/systems/by_name.hpp>
