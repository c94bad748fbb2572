#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <hamel/hamel.hpp>
TEST(Config, Works) { EXPECT_EQ(hamel::config(), "1 {\"a\":1}"); }
