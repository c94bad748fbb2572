// The page of one run.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/run/result.hpp>

#include "page.hpp"

namespace hamel::tools {

/// Verdict, energy error, constraint residual, group defect, momentum, trajectory error, the path in
/// the plane or the axes on the sphere, and the record.
Page run_page(const Result& result);

/// One column of a run against time, thinned; magnitude for a logarithmic axis.
Series curve(const Result& result, const std::string& name, const std::string& column,
             bool magnitude = true);

/// x and y of the plane, where the group has them; an empty series otherwise.
Series plane_path(const Result& result, const std::string& name);

/// The columns of R as curves on the sphere, where the group has a rotation; empty otherwise.
std::vector<SphereCurve> axes_on_sphere(const Result& result);

}  // namespace hamel::tools
