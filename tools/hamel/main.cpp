#include <CLI/CLI.hpp>
#include <iostream>
#include <hamel/hamel.hpp>
namespace hamel::tools { std::string_view report_page(); }
int main(int argc, char** argv) { CLI::App app; bool v=false; app.add_flag("--version", v); CLI11_PARSE(app, argc, argv); std::cout << hamel::version() << " " << hamel::git_hash() << " page " << hamel::tools::report_page().size() << "\n"; }
