// A grasp in a picture: a gripper of two fingers and a palm, and the way it comes.
#include "services/pose/picture_grasp.h"

#include <algorithm>
#include <array>

#include "services/pose/picture_shape.h"

namespace beckon::pose {
namespace {

constexpr double kFingerThickness_m = 0.008, kPalmThickness_m = 0.012, kArrow_m = 0.045;
const Colour kBody(150, 130, 112), kEdge(70, 56, 45), kApproach(125, 30, 150);

struct Block {
  Eigen::Vector3d centre_G, half_G;
};

std::array<Block, 3> BlocksOf(const GraspCandidate& grasp, const GripperConfig& gripper) {
  const double finger_x = 0.5 * (grasp.opening_m + kFingerThickness_m);
  const double wide = gripper.finger_half_width_m, deep = gripper.finger_depth_m;
  const Eigen::Vector3d finger(kFingerThickness_m / 2, wide, deep / 2);
  return {Block{{-finger_x, 0, -deep / 2}, finger}, Block{{finger_x, 0, -deep / 2}, finger},
          Block{{0, 0, -deep - kPalmThickness_m / 2},
                {finger_x + kFingerThickness_m / 2, wide, kPalmThickness_m / 2}}};
}

Eigen::Vector3d ArrowHead(const GripperConfig& gripper) {
  return {0, 0, -gripper.finger_depth_m - kPalmThickness_m};
}

Eigen::Vector3d ArrowTail(const GripperConfig& gripper) {
  return ArrowHead(gripper) - Eigen::Vector3d(0, 0, kArrow_m);
}

// The faces of a block that look at the eye, or away from it.
void DrawFaces(const Block& block, const Pose& X_FG, const PictureView& view, Sight sight,
               Canvas* canvas) {
  const Eigen::Vector3d eye_G = X_FG.inverse() * view.eye_F();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d middle = block.centre_G + block.half_G.cwiseProduct(normal);
      if (normal.dot(eye_G - middle) < 0) continue;
      PicturePolygon face;
      for (const auto& [s, t] : {std::pair{1, 1}, {1, -1}, {-1, -1}, {-1, 1}}) {
        Eigen::Vector3d corner = normal;
        corner[(axis + 1) % 3] = s;
        corner[(axis + 2) % 3] = t;
        const auto px = view.At(X_FG * (block.centre_G + block.half_G.cwiseProduct(corner)));
        if (px) face.push_back(*px);
      }
      if (face.size() != 4) continue;
      // Lit from the eye: a face seen at a slant is darker.
      const double slant = normal.dot((eye_G - middle).normalized());
      if (sight == Sight::kVisible) canvas->Fill(face, Lighter(kBody, 0.6 * slant));
      const Colour edge = sight == Sight::kVisible ? kEdge : Lighter(kEdge, 0.55);
      for (size_t i = 0; i < 4; ++i)
        canvas->Line(face[i], face[(i + 1) % 4], edge, sight == Sight::kVisible ? 1.2 : 0.8);
    }
  }
}

}  // namespace

void DrawGrasp(const GraspCandidate& grasp, const GripperConfig& gripper, const Superquadric& shape,
               const PictureView& view, Canvas* canvas) {
  auto blocks = BlocksOf(grasp, gripper);
  const Eigen::Vector3d eye = view.eye_F();
  const auto distance = [&](const Block& b) { return (grasp.X_FG * b.centre_G - eye).norm(); };
  std::sort(blocks.begin(), blocks.end(),
            [&](const Block& a, const Block& b) { return distance(a) > distance(b); });
  Canvas bodies = canvas->Copy();
  for (const Block& block : blocks) {
    const bool hidden = Hides(shape, eye, grasp.X_FG * block.centre_G);
    DrawFaces(block, grasp.X_FG, view, hidden ? Sight::kHidden : Sight::kVisible, &bodies);
  }
  canvas->Blend(bodies, 0.8);
  const auto tail = view.At(grasp.X_FG * ArrowTail(gripper));
  const auto head = view.At(grasp.X_FG * ArrowHead(gripper));
  if (tail && head) canvas->Arrow(*tail, *head, kApproach, 2.2, 11);
}

std::vector<Eigen::Vector3d> Extremes(const GraspCandidate& grasp, const GripperConfig& gripper) {
  std::vector<Eigen::Vector3d> points{grasp.X_FG * ArrowTail(gripper)};
  for (const Block& block : BlocksOf(grasp, gripper)) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      points.push_back(grasp.X_FG * (block.centre_G + block.half_G.cwiseProduct(signs)));
    }
  }
  return points;
}

}  // namespace beckon::pose
