#include "sim/world/traffic.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/world/actor.h"
#include "tests/sim/world/world_fixture.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

const SmallLoop& Loop() {
  static const SmallLoop loop;
  return loop;
}

ActorTextures NoTextures() {
  SceneBuilder builder(32.0, false);
  return AddActorTextures(1, builder);
}

std::vector<Actor> Busy(std::uint64_t seed) {
  return MakeTraffic({.cars = 18, .buses = 4, .pedestrians = 24}, Loop().street, seed, 60.0,
                     NoTextures());
}

Eigen::AlignedBox3f BoxOf(const std::vector<Mesh>& meshes) {
  Eigen::AlignedBox3f box;
  for (const Mesh& mesh : meshes) {
    for (const Vertex& v : mesh.vertices) box.extend(v.p_W_m);
  }
  return box;
}

bool IsPerson(const Actor& actor) { return actor.meshes.front().label == Label::kPerson; }

// The ego car is 1.76 m wide and weaves by 0.3 m: 1.18 m each side of the centre line are its own.
// An actor's first mesh is its body, whose footprint counts: mirrors and the roof of what leans on
// a slope may reach over.
TEST(Traffic, KeepsOutOfTheEgosLaneAndOnTheRoad) {
  for (const Actor& actor : Busy(1)) {
    const Eigen::AlignedBox3d box = BoxOf({actor.meshes.front()}).cast<double>();
    for (double t_s = 0.0; t_s < 60.0; t_s += 0.7) {
      const nav::Pose T_WA = *PoseOf(actor.path, nav::FromSeconds(t_s));
      for (const double x : {box.min().x(), 0.0, box.max().x()}) {
        for (const double y : {box.min().y(), box.max().y()}) {
          const Vector3d p = T_WA * Vector3d(x, y, 0.0);
          const double offset = std::abs(Loop().track.Project(p.head<2>()).offset_m);
          if (IsPerson(actor)) {
            ASSERT_GT(offset, Loop().street.half_road_m());
          } else {
            ASSERT_GT(offset, 1.18) << actor.name;
            ASSERT_LT(offset, Loop().street.half_road_m() + 0.25) << actor.name;
          }
        }
      }
    }
  }
}

TEST(Traffic, RunsIntoNobodyInItsLane) {
  const std::vector<Actor> actors = Busy(3);
  for (const double t_s : {0.0, 31.0, 59.0}) {
    std::vector<std::pair<double, double>> lane[2];  // arc length and half length
    for (const Actor& actor : actors) {
      if (IsPerson(actor)) continue;
      const auto place =
          Loop().track.Project(PoseOf(actor.path, nav::FromSeconds(t_s))->p.head<2>());
      lane[place.offset_m > 0.0].emplace_back(place.s_m, 0.5 * BoxOf(actor.meshes).sizes().x());
    }
    for (auto& in_lane : lane) {
      EXPECT_EQ(in_lane.size(), 11U);  // half of them come against the ego
      std::sort(in_lane.begin(), in_lane.end());
      for (std::size_t i = 1; i < in_lane.size(); ++i) {
        EXPECT_GT(in_lane[i].first - in_lane[i - 1].first,
                  in_lane[i].second + in_lane[i - 1].second);
      }
    }
  }
}

TEST(Traffic, IsFixedByItsSeed) {
  const auto positions = [](std::uint64_t seed) {
    std::vector<Vector3d> all;
    for (const Actor& actor : Busy(seed)) {
      all.push_back(PoseOf(actor.path, nav::FromSeconds(10.0))->p);
    }
    return all;
  };
  EXPECT_EQ(positions(5), positions(5));
  EXPECT_NE(positions(5), positions(6));
}

TEST(ActorModels, HaveTheSizesOfCarsBusesAndPeople) {
  const Vector3d bus = BoxOf(BusMeshes(NoTextures())).sizes().cast<double>();
  EXPECT_NEAR(bus.x(), 12.0, 0.3);
  EXPECT_NEAR(bus.y(), 2.55, 0.55);  // and its mirrors
  EXPECT_NEAR(bus.z(), 3.2, 0.3);
  for (std::uint64_t i = 0; i < 20; ++i) {
    RandomStream::Sample random = RandomStream(1, 0, "test").At(i);
    const Eigen::AlignedBox3f car = BoxOf(CarMeshes(NoTextures(), random));
    EXPECT_GT(car.sizes().x(), 3.9F);
    EXPECT_LT(car.sizes().x(), 4.8F);
    EXPECT_NEAR(car.min().z(), 0.0F, 0.02F);
    const Eigen::AlignedBox3f person = BoxOf(PersonMeshes(NoTextures(), random));
    EXPECT_GT(person.sizes().z(), 1.55F);
    EXPECT_LT(person.sizes().z(), 1.95F);
    EXPECT_NEAR(person.min().z(), 0.0F, 0.01F);
  }
}

// The renderer draws the side from which corners run counter-clockwise, and lights the one that
// normals point to: they must be the same.
TEST(ActorModels, ShowTheSideThatTheirNormalsPointTo) {
  RandomStream::Sample random = RandomStream(1, 0, "test").At(0);
  for (const std::vector<Mesh>& meshes : {CarMeshes(NoTextures(), random), BusMeshes(NoTextures()),
                                          PersonMeshes(NoTextures(), random)}) {
    for (const Mesh& mesh : meshes) {
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vertex& a = mesh.vertices[mesh.indices[i]];
        const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const Eigen::Vector3f out = (b.p_W_m - a.p_W_m).cross(c.p_W_m - a.p_W_m);
        if (out.norm() < 1e-7F) continue;
        EXPECT_GT(out.dot(a.normal_W + b.normal_W + c.normal_W), 0.0F);
      }
    }
  }
}

}  // namespace
}  // namespace polnav::sim
