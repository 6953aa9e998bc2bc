// Outer contours of labelled pixels.
#include "services/base/rim_contour.h"

#include <algorithm>
#include <array>

namespace beckon {
namespace {

/// Neighbouring pixels of a row with the same label.
struct Run {
  int begin = 0;  // columns begin .. end - 1
  int end = 0;
  int row = 0;
  uint16_t label = 0;
  size_t parent = 0;  // a run of the same piece that comes earlier, or itself
};

size_t Root(std::vector<Run>& runs, size_t i) {
  while (runs[i].parent != i) i = runs[i].parent = runs[runs[i].parent].parent;
  return i;
}

void AppendRunsOfRow(const LabelImage& image, int row, std::vector<Run>& runs) {
  const size_t row_begin = image.Index({0, row});
  for (int u = 0; u < image.width;) {
    if (image.labels[row_begin + u] == 0) {
      ++u;
      continue;
    }
    const uint16_t label = image.At(row_begin + u);
    const int begin = u++;
    while (u < image.width && image.At(row_begin + u) == label) ++u;
    if (label != 0) runs.push_back({begin, u, row, label, runs.size()});
  }
}

/// Joins two runs of neighbouring rows where they touch, if only at a corner.
void JoinRuns(std::vector<Run>& runs, size_t i, size_t j) {
  if (runs[i].label != runs[j].label || runs[i].begin > runs[j].end ||
      runs[j].begin > runs[i].end) {
    return;
  }
  const size_t a = Root(runs, i), b = Root(runs, j);
  runs[std::max(a, b)].parent = std::min(a, b);
}

/// Joins runs [first, middle) of a row with runs [middle, runs.size()) of the next.
void JoinRows(std::vector<Run>& runs, size_t first, size_t middle) {
  for (size_t above = first, below = middle; above < middle && below < runs.size();) {
    JoinRuns(runs, above, below);
    const int end_above = runs[above].end, end_below = runs[below].end;
    if (end_above == end_below) {  // either may touch the other's next one at a corner
      if (above + 1 < middle) JoinRuns(runs, above + 1, below);
      if (below + 1 < runs.size()) JoinRuns(runs, above, below + 1);
    }
    if (end_above <= end_below) ++above;
    if (end_below <= end_above) ++below;
  }
}

// Clockwise as seen, from the east.
constexpr std::array<Pixel, 8> kNeighbours{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

}  // namespace

std::vector<Piece> FindPieces(const LabelImage& image) {
  std::vector<Run> runs;
  size_t above = 0;
  for (int row = 0; row < image.height; ++row) {
    const size_t here = runs.size();
    AppendRunsOfRow(image, row, runs);
    JoinRows(runs, above, here);
    above = here;
  }
  std::vector<Piece> pieces;
  std::vector<size_t> piece_of(runs.size());
  for (size_t i = 0; i < runs.size(); ++i) {
    const size_t root = Root(runs, i);
    if (root == i) {
      piece_of[i] = pieces.size();
      pieces.push_back({runs[i].label, {runs[i].begin, runs[i].row}, 0});
    }
    pieces[piece_of[root]].n_pixels += runs[i].end - runs[i].begin;
  }
  return pieces;
}

std::vector<Pixel> TraceOuterContour(const LabelImage& image, Pixel first) {
  const uint16_t label = image.At(first);
  // The direction of the next border pixel after one that was entered in direction `entered`: the
  // search turns clockwise from the last pixel that was seen to be outside. -1: there is none.
  const auto next = [&](Pixel p, int entered) {
    const int begin = entered + (entered % 2 == 0 ? 6 : 5);
    for (int turn = 0; turn < 8; ++turn) {
      const int direction = (begin + turn) % 8;
      const Pixel step = kNeighbours[static_cast<size_t>(direction)];
      if (image.At({p.u + step.u, p.v + step.v}) == label) return direction;
    }
    return -1;
  };
  std::vector<Pixel> contour{first};
  const int start = next(first, 0);
  if (start < 0) return contour;
  for (int direction = start;;) {
    const Pixel step = kNeighbours[static_cast<size_t>(direction)];
    const Pixel p{contour.back().u + step.u, contour.back().v + step.v};
    direction = next(p, direction);
    if (p == first && direction == start) return contour;
    contour.push_back(p);
  }
}

}  // namespace beckon
