#include "nav/graph/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "nav/graph/edges.h"

namespace polnav::nav {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Cost 1/2 delta^T H delta + g^T delta + cost over all nodes, six entries each, and the drift,
// which comes last. Only the lower triangle of H is kept.
class SparseEquations {
 public:
  explicit SparseEquations(std::size_t nodes) : size_(6 * static_cast<Eigen::Index>(nodes) + 6) {
    Clear();
  }

  // Keeps the memory: fresh pages for each iteration cost as much as filling them.
  void Clear() {
    entries_.clear();
    g_ = Eigen::VectorXd::Zero(size_);
    cost_ = 0.0;
  }

  [[nodiscard]] std::size_t drift_block() const { return static_cast<std::size_t>(size_ / 6 - 1); }

  // Blocks must be given with their places in ascending order.
  template <int kRows, std::size_t kBlocks>
  void Add(const std::array<std::size_t, kBlocks>& places,
           const std::array<Eigen::Matrix<double, kRows, 6>, kBlocks>& jacobians,
           const Eigen::Matrix<double, kRows, 1>& residual) {
    for (std::size_t i = 0; i < kBlocks; ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(places[i]);
      g_.segment<6>(row) += jacobians[i].transpose() * residual;
      for (std::size_t j = 0; j <= i; ++j) {
        AddBlock(row, 6 * static_cast<Eigen::Index>(places[j]),
                 jacobians[i].transpose() * jacobians[j]);
      }
    }
    cost_ += 0.5 * residual.squaredNorm();
  }

  [[nodiscard]] SparseMatrix Information() const {
    SparseMatrix H(size_, size_);
    H.setFromTriplets(entries_.begin(), entries_.end());
    return H;
  }
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return g_; }
  [[nodiscard]] double cost() const { return cost_; }

 private:
  void AddBlock(Eigen::Index row, Eigen::Index column, const Matrix6d& block) {
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = 0; c <= (row == column ? r : 5); ++c) {
        entries_.emplace_back(static_cast<int>(row + r), static_cast<int>(column + c), block(r, c));
      }
    }
  }

  Eigen::Index size_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd g_;
  double cost_ = 0.0;
};

void AddStart(const PoseGraph& graph, SparseEquations& equations) {
  const Vector6d delta = Difference(graph.nodes.front().T_WB, graph.start.linearized.front());
  Matrix6d J = graph.start.jacobian;
  const Vector6d r = graph.start.residual + J * delta;
  J.rightCols<3>() = J.rightCols<3>() * InverseLeftJacobian(delta.tail<3>());
  equations.Add<6, 1>({0}, {J}, r);
}

void AddDriftPrior(const PoseGraphOptions& options, const Vector6d& drift,
                   SparseEquations& equations) {
  Vector6d weights;
  weights << Eigen::Vector3d::Constant(1.0 / options.drift_position_sigma),
      Eigen::Vector3d::Constant(1.0 / DegToRad(options.drift_angle_sigma_deg));
  equations.Add<6, 1>({equations.drift_block()}, {Matrix6d(weights.asDiagonal())},
                      weights.cwiseProduct(drift));
}

void AddStep(const PoseGraph& graph, const RelativeEdge& step, SparseEquations& equations) {
  const RelativeResidual e =
      EvaluateRelative(step, graph.nodes[step.from].T_WB, graph.nodes[step.to].T_WB, graph.drift);
  equations.Add<6, 3>({step.from, step.to, equations.drift_block()},
                      {e.by_from, e.by_to, e.by_drift}, e.residual);
}

void AddReturn(const PoseGraph& graph, const RelativeEdge& edge, double huber_sigmas,
               SparseEquations& equations) {
  const RelativeResidual e =
      EvaluateRelative(edge, graph.nodes[edge.from].T_WB, graph.nodes[edge.to].T_WB, graph.drift);
  const double norm = e.residual.norm();
  const double scale = norm <= huber_sigmas ? 1.0 : std::sqrt(huber_sigmas / norm);
  equations.Add<6, 2>({edge.from, edge.to}, {scale * e.by_from, scale * e.by_to},
                      scale * e.residual);
}

void Linearize(const PoseGraphOptions& options, const PoseGraph& graph,
               SparseEquations& equations) {
  equations.Clear();
  AddStart(graph, equations);
  AddDriftPrior(options, graph.drift, equations);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const GraphNode& node = graph.nodes[i];
    if (node.heading) {
      const HeadingResidual e = EvaluateHeading(*node.heading, node.T_WB);
      equations.Add<1, 1>({i}, {e.by_pose}, Eigen::Matrix<double, 1, 1>(e.residual));
    }
    if (node.level) {
      const LevelResidual e = EvaluateLevel(*node.level, node.T_WB);
      equations.Add<2, 1>({i}, {e.by_pose}, e.residual);
    }
  }
  for (const RelativeEdge& step : graph.steps) AddStep(graph, step, equations);
  for (const RelativeEdge& edge : graph.returns) {
    AddReturn(graph, edge, options.return_huber_sigmas, equations);
  }
}

void Step(const Eigen::VectorXd& delta, PoseGraph& graph) {
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    graph.nodes[i].T_WB =
        Perturb(graph.nodes[i].T_WB, delta.segment<6>(6 * static_cast<Eigen::Index>(i)));
  }
  graph.drift += delta.tail<6>();
}

Matrix6d NewestCovariance(const Eigen::SimplicialLDLT<SparseMatrix>& solver, std::size_t nodes) {
  const auto at = 6 * static_cast<Eigen::Index>(nodes - 1);
  Eigen::MatrixXd selector = Eigen::MatrixXd::Zero(solver.rows(), 6);
  selector.middleRows<6>(at).setIdentity();
  const Eigen::MatrixXd columns = solver.solve(selector);
  const Matrix6d covariance = columns.middleRows<6>(at);
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

RelativeResidual EvaluateRelative(const RelativeEdge& edge, const Pose& T_Wf, const Pose& T_Wt,
                                  const Vector6d& drift) {
  const Eigen::Matrix3d R_fW = T_Wf.q.conjugate().toRotationMatrix();
  const Eigen::Vector3d way_W = T_Wt.p - T_Wf.p;
  RelativeResidual e;
  e.residual.head<3>() = R_fW * way_W - edge.T_ft.p;
  e.residual.tail<3>() = LogRotation(T_Wf.q.conjugate() * T_Wt.q * edge.T_ft.q.conjugate());
  const Eigen::Matrix3d turn = InverseLeftJacobian(e.residual.tail<3>()) * R_fW;
  e.by_from.setZero();
  e.by_from.topLeftCorner<3, 3>() = -R_fW;
  e.by_from.topRightCorner<3, 3>() = R_fW * Skew(way_W);
  e.by_from.bottomRightCorner<3, 3>() = -turn;
  e.by_to.setZero();
  e.by_to.topLeftCorner<3, 3>() = R_fW;
  e.by_to.bottomRightCorner<3, 3>() = turn;
  e.residual += edge.length_m * drift;
  Vector6d weights;
  weights << Eigen::Vector3d::Constant(1.0 / edge.position_sigma_m),
      Eigen::Vector3d::Constant(1.0 / edge.angle_sigma_rad);
  e.residual = weights.asDiagonal() * e.residual;
  e.by_from = weights.asDiagonal() * e.by_from;
  e.by_to = weights.asDiagonal() * e.by_to;
  e.by_drift = edge.length_m * Matrix6d(weights.asDiagonal());
  return e;
}

PoseGraphSummary OptimizePoseGraph(const PoseGraphOptions& options, PoseGraph& graph) {
  PoseGraphSummary summary;
  PoseGraph work = graph;
  Eigen::SimplicialLDLT<SparseMatrix> solver;
  SparseEquations equations(graph.nodes.size());
  for (int i = 0; i < options.max_iterations; ++i) {
    Linearize(options, work, equations);
    const SparseMatrix H = equations.Information();
    if (i == 0) {
      solver.analyzePattern(H);
      summary.initial_cost = equations.cost();
    }
    summary.final_cost = equations.cost();
    solver.factorize(H);
    if (solver.info() != Eigen::Success) return summary;
    const Eigen::VectorXd delta = solver.solve(-equations.gradient());
    if (!delta.allFinite()) return summary;
    Step(delta, work);
    summary.iterations = i + 1;
    // 0.1 mm and 20 arc seconds: far below what any edge knows, and the step after is far smaller.
    if (delta.lpNorm<Eigen::Infinity>() < 1e-4) break;
  }
  summary.usable = true;
  summary.newest_covariance = NewestCovariance(solver, work.nodes.size());
  graph.nodes = std::move(work.nodes);
  graph.drift = work.drift;
  return summary;
}

}  // namespace polnav::nav
