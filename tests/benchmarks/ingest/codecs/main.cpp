// boresight-bench-ingest_codecs: decoding cost of each kind of input, in memory, without sockets.
#include <cstdio>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/ingest/copies/count_copies.hpp"
#include "tests/benchmarks/ingest/copies/find_sentinels.hpp"

namespace {

void print(const char* what, const boresight::bench::Copies& copies) {
  std::printf("%-48s %td intermediate, %td decoded (%s)\n", what, copies.intermediate, copies.decoded,
              copies.into_the_sinks_memory ? "in the sink's memory" : "NOT in the sink's memory");
}

void print_copies() {
  std::puts("Copies of a detection between received datagrams and scan, found by searching the process's memory:");
  print("ARS548 list, 800 detections, one datagram", boresight::bench::count_ars548_copies());
  print("SOME/IP-TP list, 1024 detections, 36 segments", boresight::bench::count_someip_copies());
}

}  // namespace

int main(int argc, char** argv) {
  if (boresight::bench::kCanFindSentinels) print_copies();
  std::puts(
      "Medians. ns/item: time per detection, frame, segment, fragment or offer, as named. x_copy: time in relation to "
      "a "
      "copy\n"
      "of the same frames; x_bswap: in relation to converting their words to host order.");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
