#include <gtest/gtest.h>
#include <ceres/jet.h>
#include <mpreal.h>
#include <hamel/hamel.hpp>
TEST(So3, Hat) { EXPECT_EQ(hamel::hat({1,2,3})(0,1), -3); mpfr::mpreal x = 1; ceres::Jet<double,2> j(1.0,0); EXPECT_EQ(sin(j).a, std::sin(1.0)); EXPECT_TRUE(x > 0);}
