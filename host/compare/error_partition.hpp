// One partition of a squared error into regions.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/compare/error_regions.hpp"

namespace host {

/// Sums of one region while rows are assigned. Regions are sorted by rank.
struct RegionSum {
  std::string region, words;
  double squares = 0.0;
  double magnitudes = 0.0;
  double weight = 0.0;
};

class Partition {
 public:
  explicit Partition(std::string name) : name_(std::move(name)) {}

  void define(long rank, std::string region, std::string words) {
    sums_.try_emplace(rank, RegionSum{std::move(region), std::move(words)});
  }
  bool has(long rank) const { return sums_.contains(rank); }
  void add(long rank, double square, double weight = 1.0) {
    RegionSum& sum = sums_.at(rank);
    sum.squares += square;
    sum.magnitudes += std::sqrt(square);
    sum.weight += weight;
  }

  void append_to(std::vector<ErrorRegion>& regions) const {
    double squares = 0.0, magnitudes = 0.0, weight = 0.0;
    for (const auto& [rank, sum] : sums_) {
      squares += sum.squares;
      magnitudes += sum.magnitudes;
      weight += sum.weight;
    }
    if (!(squares > 0.0)) return;
    for (const auto& [rank, sum] : sums_) {
      if (sum.weight <= 0.0) continue;
      regions.push_back({name_, sum.region, sum.words, sum.squares / squares, sum.weight / weight,
                         std::sqrt(sum.squares / sum.weight), sum.magnitudes / magnitudes});
    }
  }

 private:
  std::string name_;
  std::map<long, RegionSum> sums_;
};

}  // namespace host
