// The text of a ConfigError.
#pragma once

#include <string>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

template <class Act>
std::string refusal(Act&& act) {
  try {
    act();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace hamel
