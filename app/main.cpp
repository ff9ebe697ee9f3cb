#include <barchan/app/command.hpp>

int main(int argc, char** argv) {
  return barchan::app::run_barchan(argc, argv);
}
