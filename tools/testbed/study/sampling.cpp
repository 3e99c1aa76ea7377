#include "tools/testbed/study/sampling.h"

#include <boost/random/sobol.hpp>
#include <numeric>
#include <stdexcept>

#include "sim/random.h"

namespace polnav::testbed {
namespace {

// The middle of one of 2^53 cells: never 0 nor 1.
double CellMiddle(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; }

std::uint64_t Bits64(sim::RandomStream::Sample& draw) {
  const std::uint64_t high = draw.Bits();
  return high << 32 | draw.Bits();
}

// Fisher and Yates.
std::vector<std::uint32_t> Permutation(std::uint64_t count, const sim::RandomStream& stream) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint64_t i = count; i > 1; --i) {
    const auto j = static_cast<std::uint64_t>(stream.At(i).Uniform() * static_cast<double>(i));
    std::swap(order[i - 1], order[j]);
  }
  return order;
}

}  // namespace

struct UnitSampler::Sobol {
  explicit Sobol(std::size_t dimensions) : engine(dimensions) {}
  boost::random::sobol engine;
};

Sampling ParseSampling(const std::string& name) {
  if (name == "random") return Sampling::kRandom;
  if (name == "latin_hypercube") return Sampling::kLatinHypercube;
  if (name == "sobol") return Sampling::kSobol;
  throw std::logic_error("no sampling is called " + name);
}

std::size_t MaxSobolDimensions() { return boost::random::default_sobol_table::max_dimension; }

UnitSampler::UnitSampler(Sampling sampling, std::uint64_t seed, std::uint64_t samples,
                         std::vector<std::string> dimensions)
    : sampling_(sampling), seed_(seed), samples_(samples), dimensions_(std::move(dimensions)) {
  if (dimensions_.empty()) return;
  if (sampling_ == Sampling::kLatinHypercube) {
    for (const std::string& name : dimensions_) {
      strata_.push_back(Permutation(samples, sim::RandomStream(seed, 0, "study/strata/" + name)));
    }
  } else if (sampling_ == Sampling::kSobol) {
    sobol_ = std::make_unique<Sobol>(dimensions_.size());
    for (const std::string& name : dimensions_) {
      auto draw = sim::RandomStream(seed, 0, "study/shift/" + name).At(0);
      shifts_.push_back(Bits64(draw));
    }
  }
}

UnitSampler::~UnitSampler() = default;

double UnitSampler::Independent(std::uint64_t sample, std::size_t dimension) const {
  auto draw = sim::RandomStream(seed_, sample, "study/value/" + dimensions_[dimension]).At(0);
  return CellMiddle(Bits64(draw));
}

std::vector<std::uint64_t> UnitSampler::SobolPoint(std::uint64_t sample) const {
  std::vector<std::uint64_t> point(dimensions_.size(), 0);
  if (sample == 0) return point;  // Boost leaves out the origin
  boost::random::sobol engine = sobol_->engine;
  engine.seed(sample - 1);
  for (std::uint64_t& coordinate : point) coordinate = engine();
  return point;
}

std::vector<double> UnitSampler::At(std::uint64_t sample) const {
  std::vector<double> u(dimensions_.size());
  if (sampling_ == Sampling::kSobol && !u.empty()) {
    const std::vector<std::uint64_t> point = SobolPoint(sample);
    for (std::size_t d = 0; d < u.size(); ++d) u[d] = CellMiddle(point[d] ^ shifts_[d]);
    return u;
  }
  for (std::size_t d = 0; d < u.size(); ++d) {
    u[d] = Independent(sample, d);
    if (sampling_ != Sampling::kLatinHypercube) continue;
    if (sample >= samples_) throw std::logic_error("beyond the Latin hypercube's last sample");
    u[d] = (strata_[d][sample] + u[d]) / static_cast<double>(samples_);
  }
  return u;
}

}  // namespace polnav::testbed
