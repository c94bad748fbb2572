// expect: hamel/solvers/newton\.hpp: No such file
// layer: groups
#include <hamel/groups/so3.hpp>
#ifdef MISTAKE  // groups and solvers do not see each other
#include <hamel/solvers/newton.hpp>
#endif
