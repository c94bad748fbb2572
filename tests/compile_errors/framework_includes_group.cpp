// expect: hamel/groups/so3.hpp: No such file or directory
// layer: framework
#ifdef MISTAKE
#include <hamel/groups/so3.hpp>
#endif
#include <hamel/framework/types.hpp>
int main() {}
