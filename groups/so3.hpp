#pragma once
#include <hamel/framework/types.hpp>
#include <Eigen/Dense>
namespace hamel { struct SE2 {}; inline Mat<3,3> hat(const Vec<3>& w) { return Mat<3,3>{{0,-w[2],w[1]},{w[2],0,-w[0]},{-w[1],w[0],0}}; } }
