// Standard output and standard error: what cannot be written there ends no program, and what is
// lost on standard output makes its exit status 1.
#pragma once

#include <string_view>

#include <fmt/format.h>

#include <hamel/framework/io/visible.hpp>

namespace hamel::tools {

/// Before any file is opened: closed standard streams get descriptors, so that no file
/// of a run becomes one, and a closed pipe or a limit on files is an error of the write instead of
/// a signal.
void begin_screen();

/// Text on standard output as it is; Unfinished where it cannot be written.
void write_screen(std::string_view text);
/// Brings it there; Unfinished likewise.
void finish_screen();
/// Text on standard error as it is, where that can be written.
void write_message(std::string_view text);

/// Writes with a format, and with control characters made visible.
template <class... T>
void say(fmt::format_string<T...> format, T&&... values) {
  write_screen(visible(fmt::format(format, std::forward<T>(values)...)));
}
template <class... T>
void complain(fmt::format_string<T...> format, T&&... values) {
  write_message(visible(fmt::format(format, std::forward<T>(values)...)));
}

/// A JSON value on standard output; what is no UTF-8 in it is replaced.
template <class Json>
void say_json(const Json& json) {
  say("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace hamel::tools
