#include <hamel/groups/so3.hpp>
#include <hamel/framework/version.hpp>
#include <hamel/systems/simulate.hpp>
namespace hamel { std::string Result::report() const { return config() + std::string(git_hash()) + "\n"; } Result Sim::run() { return {}; } }
