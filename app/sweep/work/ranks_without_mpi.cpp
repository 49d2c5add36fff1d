#include "ranks.hpp"

#include <lagroid/run/files/output_folder.hpp>

namespace lagroid::app {

std::unique_ptr<Ranks> join_mpi() {
  throw RunError(
      "started by mpirun or srun, but this lagroid was built without MPI: install libopenmpi-dev and build it again, "
      "or "
      "start one process");
}

}  // namespace lagroid::app
