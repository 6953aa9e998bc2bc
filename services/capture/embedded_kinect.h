// What a Kinect makes of a rendering: depth by block matching of a projected pattern, and a noisy
// colour image.
#pragma once

#include "services/capture/embedded_raycaster.h"

namespace beckon::capture {

/// Depth errors arise in the disparity of the pattern (Khoshelham & Elberink, "Accuracy and
/// Resolution of Kinect Depth Data", 2012): noise that is correlated over the matching window, then
/// steps of 1/8 px.
struct KinectNoise {
  double baseline_focal_m_px = 42.9;  // disparity in px = this / depth
  double sigma_px = 0.045;            // of the disparity, fine part
  double correlation_u_px = 1.3;      // of the fine part, along rows
  double correlation_v_px = 0.8;
  double coarse_sigma_px = 0.03;  // of a part that varies over some 8 px
  double step_px = 0.125;
  double smoothing_px = 1.0;    // of the matching window, within a surface
  double ragged_px = 0.9;       // how far outlines stray
  double edge_dropout = 0.3;    // share of outline pixels without depth
  double shadow_dropout = 0.7;  // share of the projector's shadow without depth
};

/// The noise of one camera at one moment.
KinectNoise RandomKinectNoise(Random& random);

struct KinectDepth {
  std::vector<float> depth_m;    // 0 = no depth; whole millimetres
  std::vector<uint16_t> labels;  // of the surface each depth was taken from; 0 where there is none
};

KinectDepth SimulateDepth(const Rendering& rendering, const KinectNoise& noise, Random& random);

/// Blurs a little, adds sensor noise, clips.
std::vector<Rgb> SimulateColour(const Rendering& rendering, Random& random);

/// White noise blurred by a Gaussian, of unit variance.
std::vector<float> SmoothNoise(int width, int height, double sigma_u_px, double sigma_v_px,
                               Random& random);

}  // namespace beckon::capture
