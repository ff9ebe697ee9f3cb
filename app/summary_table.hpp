#pragma once

#include <barchan/core/model/model.hpp>
#include <barchan/tasks/results/run_folder.hpp>
#include <barchan/tasks/results/run_summary.hpp>

namespace barchan::app {

/// Prints a run in a dozen lines to stdout, and where its results are.
void print_summary(const RunSummary& summary, const RunFolder& folder, const Model& model);

}  // namespace barchan::app
