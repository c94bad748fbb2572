// The members of an ensemble that its figures show as dots.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/figures/figure.hpp>

namespace hamel::figures {

/// A column of numbers, by member.
const std::vector<double>& numbers_of(const EnsembleResult& result, const std::string& name);
/// Its unit; "" of a plain number.
std::string unit_of(const EnsembleResult& result, const std::string& name);
/// The values of these members.
std::vector<double> chosen(const std::vector<double>& all, const std::vector<long>& index);
/// 0, stride, 2 stride, ... below count.
std::vector<long> every(size_t count, size_t stride);

std::vector<bool> failed_members(const EnsembleResult& result);
/// The class of each member, by number, or -1; 0 of all without classes.
std::vector<long long> classes_of(const EnsembleResult& result);

/// Each stride-th member is drawn as a dot; on a grid it shares no factor with the lists, so that
/// it does not miss most of their values.
size_t stride_of_dots(const EnsembleResult& result);

/// 21 -> "21st".
std::string ordinal(size_t n);

/// "Each 25th member."; "" where all are shown.
std::string sampled(size_t stride);

/// A dot for each member in each pair of what is kept, with the correlations; nothing where fewer
/// than two columns vary.
void add_scatter_matrix(std::vector<Figure>& out, const EnsembleResult& result);

}  // namespace hamel::figures
