// Figures that the reports of a diagnosis and of an improvement share.
#pragma once

#include "host/diagnose/diagnosis.hpp"
#include "host/report/report.hpp"

namespace host {

/// The unexplained effort on validation data against the coordinates in which effects show, before (the base, fitted
/// again) and after (`best`).
void add_residuals(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best);

/// Whether what is left is noise: its correlation with itself and with the command, with the bounds that a white one
/// keeps, and how much of it depends on each coordinate.
void add_whiteness(Report& report, const Diagnosis& diagnosis);

/// The first validation record: measured, predicted by `best`, and the errors before and after.
void add_traces(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best);

/// Error over floor of the likeliest candidates, without and with each.
BarChart candidate_chart(const Diagnosis& diagnosis);

}  // namespace host
