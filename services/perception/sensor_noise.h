// How far a depth camera errs at a distance, so that thresholds follow the sensor.
#pragma once

namespace beckon::perception {

/// Noise of depth along the optical axis, sigma(z) = floor + growth (z - from)^2. Defaults: the
/// Kinect's, after Nguyen, Izadi & Lovell ("Modeling Kinect Sensor Noise for Improved 3D
/// Reconstruction and Tracking", 2012, eq. 3), which holds the steps its readings come in
/// (Khoshelham & Elberink, "Accuracy and Resolution of Kinect Depth Data", 2012: disparity in 1/8
/// px, that is 2.9 mm at 1 m, growing with the square of the depth).
///
/// Segmentation works on inverse depth w = 1/z: there a plane is linear in the pixel (w = n·ray / d
/// for the plane n·p = d), steps are equal at all distances, and the noise of a camera that
/// triangulates hardly changes with distance.
struct SensorNoise {
  double floor_m = 0.0012;
  double growth_per_m = 0.0019;
  double from_m = 0.4;

  /// Standard deviation of the depth at z, m.
  double Sigma(double z_m) const {
    return floor_m + growth_per_m * (z_m - from_m) * (z_m - from_m);
  }
};

/// The same for inverse depth, 1/m, in floats for inner loops: sigma_w(w) = sigma(1/w) w^2.
struct InverseDepthNoise {
  float square, offset, growth;

  explicit InverseDepthNoise(const SensorNoise& sensor)
      : square(static_cast<float>(sensor.floor_m)),
        offset(static_cast<float>(sensor.from_m)),
        growth(static_cast<float>(sensor.growth_per_m)) {}

  float operator()(float w) const {
    const float far = 1 - offset * w;
    return square * w * w + growth * far * far;
  }
};

}  // namespace beckon::perception
