// What a depth camera makes of a rendering: depth by block matching of a projected pattern, as a
// Kinect does it, or as other kinds of cameras come to it; and a noisy colour image.
#pragma once

#include "services/capture/embedded_raycaster.h"

namespace beckon::capture {

/// Depth errors arise in the disparity of the pattern (Khoshelham & Elberink, "Accuracy and
/// Resolution of Kinect Depth Data", 2012): noise that is correlated over the matching window, then
/// steps of 1/8 px.
struct DepthNoise {
  double baseline_focal_m_px = 42.9;  // disparity in px = this / depth
  // Two parts of noise; variance, correlation and steps match those measured in frames of tables:
  // residual of a plane .07 px within 13x13 px, .08 within 25x25, 72 % of neighbours equal.
  double sigma_px = 0.045;
  double correlation_u_px = 0.7;  // along rows
  double correlation_v_px = 0.6;
  double coarse_sigma_px = 0.07;
  double coarse_correlation_u_px = 3.2;
  double coarse_correlation_v_px = 1.5;
  double step_px = 0.125;
  double smoothing_px =
      2.2;  // of the matching window, within a surface: as creases of real boxes are rounded
  double ragged_px = 0.7;       // how far outlines stray
  double edge_dropout = 0.06;   // share of outline pixels without depth
  double shadow_dropout = 0.7;  // share of the projector's shadow without depth
  double flying = 0;            // share of outline pixels that lie between the two surfaces
};

/// The noise of one camera at one moment.
DepthNoise RandomKinectNoise(Random& random);

/// A depth camera that a lab may have: a projected pattern (Kinect 1, Xtion), time of flight
/// (Kinect 2, Azure) or active stereo (RealSense), its image registered to 640x480.
struct DepthCamera {
  Intrinsics intrinsics;
  DepthNoise noise;
};
DepthCamera RandomDepthCamera(Random& random);

struct KinectDepth {
  std::vector<float> depth_m;    // 0 = no depth; whole millimetres
  std::vector<uint16_t> labels;  // of the surface each depth was taken from; 0 where there is none
};

KinectDepth SimulateDepth(const Rendering& rendering, const DepthNoise& noise, Random& random);

/// Blurs a little, adds sensor noise, clips.
std::vector<Rgb> SimulateColour(const Rendering& rendering, Random& random);

/// White noise blurred by a Gaussian, of unit variance.
std::vector<float> SmoothNoise(int width, int height, double sigma_u_px, double sigma_v_px,
                               Random& random);

}  // namespace beckon::capture
