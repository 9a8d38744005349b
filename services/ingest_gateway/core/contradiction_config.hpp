// Settings of the test whether range rates contradict the vehicle's motion: table [contradiction] of the gateway's
// file.
#pragma once

namespace boresight::ingest {

struct ContradictionConfig {
  /// Below, range rates of stationary reflectors are too similar to those of slow traffic (choice).
  double least_speed_mps = 5.0;
  /// Highest speed in reverse. Without a signal of the direction of travel, the opposite sign may be true below it
  /// (choice).
  double fastest_reverse_mps = 10.0;
  /// Time for which the same objects fill the view: moving objects imitate another speed of the sensor, or hide all
  /// stationary reflectors, for so long (choice: a truck of 16 m passes at 16 m/s).
  double scene_s = 1.0;
  /// Correlation of detections of stationary reflectors from scan to scan (measured: RadarScenes, 41 % are seen again
  /// beyond chance).
  double seen_again = 0.45;
  /// Probabilities that a decision is wrong (choice): about one false alarm in a million observations of a sound radar,
  /// one false return in a thousand of a wrong one, which is found wrong again soon.
  double false_alarm = 1e-5, false_return = 1e-2;

  /// Time over which the share of stationary detections is learnt (choice: longer than a traffic jam's first seconds,
  /// shorter than a kind of road), and the time after which what was learnt counts as much as the prior (choice).
  double memory_s = 60.0, prior_s = 5.0;
  /// Deviations below the mean that a scene may have (choice: 2 % have less).
  double sigma = 2.0;
  /// A radar of many detections reports the stationary world: the share before any is learnt, to more of which no radar
  /// is held (choice: under interference most detections are false), and the least (choice: a fifth in dense traffic).
  double usual_share = 0.3, least_share = 0.1;
  /// A radar with no more detections may report tracks of moving objects only (choice: such radars have 12 … 20
  /// tracks).
  double few_detections = 20.0;
};

}  // namespace boresight::ingest
