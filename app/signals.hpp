#pragma once

// What signals and closed streams do to a run; docs/run_folder.md.

namespace barchan::app {

/// Opens /dev/null for each of the streams 0, 1 and 2 that is closed, so that no file of a run gets
/// its number and with it what is printed.
void keep_standard_streams();

/// From the very beginning of a run: SIGUSR1 asks for a checkpoint, which waits for a state, and a
/// reader of its output that goes away (SIGPIPE) does not end it.
void catch_early_signals();

/// Once there is something to save: SIGINT, SIGTERM and SIGHUP end the run after its step; a second
/// one of the same kind ends the program as usual. A SIGHUP that is ignored, as under nohup, stays
/// so.
void catch_signals();

}  // namespace barchan::app
