// SPDX-License-Identifier: GPL-3.0-or-later
// A network of conductances, solved by star-mesh transformation. Node k with links g_kj is replaced by links g_ki g_kj
// / S_k between its neighbours, with S_k the sum of all its links. This is Gaussian elimination without a subtraction.
// Conductances may therefore differ by any number of orders of magnitude, and a sealed sac stays accurate beside an
// open artery. Sources: Rosen 1924 (star-mesh); Grassmann, Taksar, Heyman 1985 (elimination without cancellation).
#pragma once
#include <vector>

namespace insula {

class StarMesh {
 public:
  /// n nodes without links. Allocates only when n grows.
  void clear(int n);
  int nodes() const { return n_; }
  void link(int i, int j, double g);                               ///< conductance between two nodes, m3/(s Pa)
  void ground(int i, double g, double p);                          ///< conductance to a given pressure p, Pa
  void source(int i, double q) { current_[std::size_t(i)] += q; }  ///< inflow from outside, m3/s

  double link(int i, int j) const { return g_[std::size_t(i * n_ + j)]; }
  double ground(int i) const { return ground_[std::size_t(i)]; }
  double current(int i) const {
    return current_[std::size_t(i)];
  }  ///< source of a node, with the sources of eliminated ones

  /// Nodes are eliminated in ascending order. Afterwards link(k, j), j > k, are the links of node k at its elimination.
  void eliminate(int k);
  double pivot(int k) const { return pivot_[std::size_t(k)]; }  ///< sum of all links of node k when it was eliminated
  double share(int k, int j) const { return pivot(k) > 0 ? link(k, j) / pivot(k) : 0; }
  /// The pressure of an eliminated node from those of the later ones, or `floating` if it has no links.
  double pressure(int k, const double* p, double floating) const;

 private:
  int n_ = 0;
  std::vector<double> g_, ground_, current_, pivot_;
};

}  // namespace insula
