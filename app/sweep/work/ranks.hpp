#pragma once
/// The processes that `mpirun` or `srun` started together.

#include <memory>
#include <optional>
#include <string>

namespace lagroid::app {

/// What ranks tell each other; the schedule gives it a meaning.
struct Message {
  int kind = 0;
  long value = 0;
  std::string text;
};

/// This process among others like it, numbered from 0. Only the thread that made it may ask anything of it.
class Ranks {
 public:
  struct Received {
    int from;
    Message message;
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Does not wait until it is received.
  virtual void send(int to, const Message& message) = 0;
  /// One that has come; none where there is none now.
  virtual std::optional<Received> receive() = 0;
  /// What rank 0 passes, on all ranks.
  virtual std::string broadcast(const std::string& text) = 0;
  /// Tells why, and ends all ranks, which would wait for this one; does nothing where there is no other.
  virtual void abort(const std::string&) {}
};

/// Joins those that were started with this process; one process by itself is rank 0 of 1. MPI begins here, where the
/// environment says that there are others, and nowhere else; it ends with the last use of what is returned. Throws
/// RunError where there are others but lagroid was built without MPI.
std::unique_ptr<Ranks> join_ranks();

/// The ranks of MPI: in ranks_mpi.cpp, or, built without it, in ranks_without_mpi.cpp.
std::unique_ptr<Ranks> join_mpi();

}  // namespace lagroid::app
