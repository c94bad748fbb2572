#pragma once
#include <string>
#include <hamel/groups/so3.hpp>
namespace hamel { std::string config(); 
struct Result { std::string report() const; explicit operator bool() const { return true;} };
struct Start { Vec<3> velocity; };
struct Sim { template<class T> Sim(T&&){}; Sim& step(double){return *this;} Sim& until(double){return *this;} Sim& start(Start) {return *this;} Result run(); };
template<class T> Sim simulate(T&& t) { return Sim(t); }
}
