// expect: hamel/groups/so3\.hpp: No such file
// layer: run
#include <hamel/framework/lie/concepts.hpp>
#ifdef MISTAKE  // the framework depends on no particular group
#include <hamel/groups/so3.hpp>
#endif
