#pragma once

namespace barchan::app {

/// The whole command. @return exit status: 0 done, 1 failed while running, 2 input wrong
int run_barchan(int argc, char** argv);

}  // namespace barchan::app
