// boresight-bench-ingest_codecs: what the gateway takes to understand each kind of input, in memory, without sockets.
#include <cstdio>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/ingest/copies/count_copies.hpp"
#include "tests/benchmarks/ingest/copies/find_sentinels.hpp"

namespace {

void print(const char* what, const boresight::bench::Copies& copies) {
  std::printf("%-48s %zu intermediate, %zu decoded (%s)\n", what, copies.intermediate, copies.decoded,
              copies.into_the_sinks_memory ? "in the sink's memory" : "NOT in the sink's memory");
}

void print_copies() {
  std::puts("copies of a detection between received datagrams and scan, found by a search of the process's memory:");
  print("ARS548 list, 800 detections, one datagram", boresight::bench::count_ars548_copies());
  print("SOME/IP-TP list, 1024 detections, 36 segments", boresight::bench::count_someip_copies());
}

}  // namespace

int main(int argc, char** argv) {
  if (boresight::bench::kCanFindSentinels) print_copies();
  std::puts(
      "median; ns/item: time for what the name says \"per\"; x_copy, x_bswap: the whole beside a copy of the same "
      "frames,\n"
      "and beside turning their words to host order");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
