#pragma once

#include <string>

#include <barchan/app/command_line.hpp>
#include <barchan/comm/base/communicator.hpp>

namespace barchan::app {

/// `barchan run`. Collective. Errors: InputError, the same on every rank; RunError.
void run_deck(const Communicator& world, const RunArguments& arguments);

/// `barchan check`. Local, without MPI. Errors: InputError.
void check_deck(const CheckArguments& arguments);

/// `barchan probe`: what every exchange costs between these ranks. Collective. Errors: InputError.
void probe(const Communicator& world, const ProbeArguments& arguments);

/// `barchan info` and `barchan convert`. Local, without MPI. Errors: InputError.
void show_info(const std::string& path);
void convert(const ConvertArguments& arguments);

/// `barchan sweep`: runs a deck at every point of the axes, again and again, as processes of their
/// own. Without MPI. Errors: InputError; RunError when a run failed or the sweep was interrupted.
void sweep(const SweepArguments& arguments);

/// `barchan table` and `barchan compare`: what runs that exist took. Without MPI.
/// Errors: InputError.
void print_runs(const TableArguments& arguments);
void compare(const CompareArguments& arguments);

/// `barchan report`: a page for a browser, of a run, a sweep or a deck. Without MPI.
/// Errors: InputError.
void report(const ReportArguments& arguments);

/// `barchan watch`: how far a run is, until it ends. Without MPI.
/// Errors: InputError; RunError when the run died.
void watch(const WatchArguments& arguments);

}  // namespace barchan::app
