#include "tests/system/harness/two_hosts.hpp"

int main(int argc, char** argv) {
  return boresight::network::run_tests_on_two_hosts(argc, argv);
}
