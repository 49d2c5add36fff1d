#include "ranks.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace lagroid::app {

namespace {

class Alone final : public Ranks {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void send(int, const Message&) override {}
  std::optional<Received> receive() override { return std::nullopt; }
  std::string broadcast(const std::string& text) override { return text; }
};

/// Whether a launcher of MPI programs started this process: Open MPI's mpirun, Hydra's and srun's (PMI, PMIx).
bool launched() {
  constexpr std::array<const char*, 3> signs{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  return std::any_of(signs.begin(), signs.end(), [](const char* sign) { return std::getenv(sign) != nullptr; });
}

}  // namespace

std::unique_ptr<Ranks> join_ranks() {
  if (launched()) return join_mpi();
  return std::make_unique<Alone>();
}

}  // namespace lagroid::app
