// Agglomeration with a heap of edges, the outdated of which are skipped.
#include "services/perception/region_clustering.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace beckon::perception {
namespace {

// Evidence that a border must show for each cell of the smaller group's width: faces of one object
// meet along an edge as long as they are wide, objects that happen to touch often do not.
constexpr float kShortBorder = 0.08f;
// Cells of border without evidence that are added to each: of two means alike the one of the longer
// border comes first, and a single cell does not bridge two objects before they have grown.
constexpr float kDoubt = 2;

class Agglomeration {
 public:
  Agglomeration(std::span<const float> sizes, std::span<const SignedEdge> edges)
      : edges_(edges.begin(), edges.end()),
        version_(edges.size(), 0),
        edges_of_(sizes.size()),
        parent_(sizes.size()),
        size_(sizes.begin(), sizes.end()) {
    for (size_t i = 0; i < sizes.size(); ++i) parent_[i] = static_cast<int>(i);
    for (size_t e = 0; e < edges_.size(); ++e) {
      edges_[e].evidence *= edges_[e].length;  // a sum from here on
      edges_of_[edges_[e].a].push_back(static_cast<int>(e));
      edges_of_[edges_[e].b].push_back(static_cast<int>(e));
      Push(static_cast<int>(e));
    }
  }

  void Run() {
    while (!heap_.empty()) {
      const Entry top = heap_.top();
      heap_.pop();
      if (top.version != version_[top.edge]) continue;
      const float mean = Mean(edges_[top.edge]);  // the groups may have grown
      if (mean < top.mean) {
        if (mean > 0) heap_.push({mean, top.edge, top.version});
      } else {
        Merge(top.edge);
      }
    }
  }

  std::vector<int> Groups() {
    std::vector<int> group(parent_.size(), -1), number(parent_.size(), -1);
    int n = 0;
    for (size_t i = 0; i < parent_.size(); ++i) {
      const int root = Find(static_cast<int>(i));
      if (number[root] < 0) number[root] = n++;
      group[i] = number[root];
    }
    return group;
  }

 private:
  struct Entry {
    float mean;
    int edge;
    int version;
    bool operator<(const Entry& other) const {
      return mean < other.mean || (mean == other.mean && edge > other.edge);
    }
  };

  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void Push(int e) {
    const SignedEdge& edge = edges_[e];
    const float mean = Mean(edge);
    if (mean > 0) heap_.push({mean, e, version_[e]});
  }

  /// Of the evidence, less what a border must show that is short for the smaller group's size.
  float Mean(const SignedEdge& edge) const {
    if (edge.length <= 0) return 0;
    const float width = std::sqrt(std::min(size_[edge.a], size_[edge.b]));
    return (edge.evidence - kShortBorder * width) / (edge.length + kDoubt);
  }

  /// Joins the ends of an edge; the one with fewer edges is taken into the other.
  void Merge(int e) {
    int keep = edges_[e].a, gone = edges_[e].b;
    if (edges_of_[keep].size() < edges_of_[gone].size()) std::swap(keep, gone);
    parent_[gone] = keep;
    size_[keep] += size_[gone];
    version_[e] = -1;
    std::erase(edges_of_[keep], e);
    for (int moved : edges_of_[gone]) {
      if (version_[moved] < 0) continue;
      SignedEdge& edge = edges_[moved];
      const int other = edge.a == gone ? edge.b : edge.a;
      const int twin = EdgeBetween(keep, other);
      if (twin >= 0) {
        edges_[twin].evidence += edge.evidence;
        edges_[twin].length += edge.length;
        ++version_[twin];
        version_[moved] = -1;
        std::erase(edges_of_[other], moved);
        Push(twin);
      } else {
        (edge.a == gone ? edge.a : edge.b) = keep;
        edges_of_[keep].push_back(moved);
      }
    }
    edges_of_[gone].clear();
  }

  int EdgeBetween(int i, int j) const {
    const auto& list = edges_of_[i].size() < edges_of_[j].size() ? edges_of_[i] : edges_of_[j];
    for (int e : list) {
      if (edges_[e].a + edges_[e].b == i + j && (edges_[e].a == i || edges_[e].a == j)) return e;
    }
    return -1;
  }

  std::vector<SignedEdge> edges_;
  std::vector<int> version_;  // of each edge; -1 = gone
  std::vector<std::vector<int>> edges_of_;
  std::vector<int> parent_;
  std::vector<float> size_;
  std::priority_queue<Entry> heap_;
};

}  // namespace

std::vector<int> ClusterSignedGraph(std::span<const float> sizes,
                                    std::span<const SignedEdge> edges) {
  Agglomeration agglomeration(sizes, edges);
  agglomeration.Run();
  return agglomeration.Groups();
}

}  // namespace beckon::perception
