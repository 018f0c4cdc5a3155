// The sum of all probabilities of a verdict, which must be 1.
#pragma once

#include "host/diagnose/diagnosis.hpp"

inline double sum_of_probabilities(const host::Diagnosis& diagnosis) {
  double sum = diagnosis.verdict.probability_nothing + diagnosis.verdict.probability_other;
  for (const host::JudgedCandidate& judged : diagnosis.candidates) sum += judged.probability;
  return sum;
}
