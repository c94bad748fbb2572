// hamel: the command line. Its options, files and formats: tools/README.md.
#include "hamel_main.hpp"

int main(int argc, char** argv) { return hamel::tools::hamel_main(argc, argv); }
