// Names of quantities in written equations. Not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/graph/notation.hpp>

namespace hamel {

/// omega1 is \omega_{1}, steer.angle \mathrm{angle}_{\mathrm{steer}}, theta' \dot{\theta}.
std::string latex_name(const std::string& name);
/// The rate of a value with such a name.
std::string latex_rate(const std::string& name);
/// A name in C and Python: steer_angle, theta_rate.
std::string identifier(const std::string& name);
/// Names of the inputs of a recording, each once; behind t.
std::vector<std::string> names_of(const std::vector<std::string>& inputs, graph::Notation notation);
/// A letter with which no name begins that has digits behind it.
std::string free_prefix(const std::vector<std::string>& names);
/// Does a name occur as a word of its own?
bool occurs(const std::string& name, const std::string& in);

}  // namespace hamel
