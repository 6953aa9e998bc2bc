// Smoothing a cloud by moving least squares.
#pragma once

#include "services/pose/fit_stage.h"

namespace beckon::pose {

/// Every point moved onto the quadratic patch through its neighbours within `radius_m`: heights
/// over their plane of least squares, fitted with weights exp(-d^2 / radius^2) (moving least
/// squares, Alexa, Behr, Cohen-Or, Fleishman, Levin & Silva 2003, "Computing and rendering point
/// set surfaces"). Points with fewer than six neighbours, and those whose neighbours do not
/// determine a patch, stay. Time grows with the points times their neighbours.
PointList SmoothedByMovingLeastSquares(const PointList& points, double radius_m);

}  // namespace beckon::pose
