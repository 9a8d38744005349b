#include "services/alignment_estimator/station/core/seeding.hpp"

namespace boresight::alignment::station {

bool seed_estimator(const RotationSeed& seed, Estimator& estimator) {
  Memory memory = estimator.memory();
  if (memory.number_of_radars == 0 || !put_seed(seed, memory)) return false;
  estimator.restore(memory);
  return true;
}

}  // namespace boresight::alignment::station
