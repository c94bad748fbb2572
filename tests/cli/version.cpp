#include <gtest/gtest.h>
#include <cstdlib>
TEST(Cli, Version) { ASSERT_NE(std::getenv("HAMEL_PROGRAM"), nullptr); EXPECT_EQ(std::system((std::string(std::getenv("HAMEL_PROGRAM")) + " --version").c_str()), 0); }
