// The program by its words: what main calls, and what the playground's terminal calls.
#pragma once

namespace hamel::tools {

/// Carries out a command line and returns the exit status.
int hamel_main(int argc, char** argv);

}  // namespace hamel::tools
