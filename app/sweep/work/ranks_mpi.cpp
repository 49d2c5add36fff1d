#include "../../command/command.hpp"
#include "ranks.hpp"

#include <mpi.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace lagroid::app {

namespace {

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;
  ~MpiRanks() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, const Message& message) override {
    std::string bytes(sizeof message.value, '\0');
    std::memcpy(bytes.data(), &message.value, sizeof message.value);
    bytes += message.text;
    MPI_Send(bytes.data(), int(bytes.size()), MPI_CHAR, to, message.kind, MPI_COMM_WORLD);
  }

  std::optional<Received> receive() override {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    std::string bytes(std::size_t(size), '\0');
    MPI_Recv(bytes.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    Received out{status.MPI_SOURCE, {status.MPI_TAG, 0, {}}};
    std::memcpy(&out.message.value, bytes.data(), sizeof out.message.value);
    out.message.text = bytes.substr(sizeof out.message.value);
    return out;
  }

  std::string broadcast(const std::string& text) override {
    long size = long(text.size());
    MPI_Bcast(&size, 1, MPI_LONG, 0, MPI_COMM_WORLD);
    std::string out = text;
    out.resize(std::size_t(size));
    constexpr long most = 1 << 30;  // MPI counts by int
    for (long at = 0; at < size; at += most)
      MPI_Bcast(out.data() + at, int(std::min(most, size - at)), MPI_CHAR, 0, MPI_COMM_WORLD);
    return out;
  }

  void abort(const std::string& why) override {
    if (size_ == 1) return;
    complain(
        fmt::format("rank {}: {}; the finished parts are kept, and the same command goes on from them", rank_, why));
    MPI_Abort(MPI_COMM_WORLD, exit_failed);
  }

 private:
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace

std::unique_ptr<Ranks> join_mpi() { return std::make_unique<MpiRanks>(); }

}  // namespace lagroid::app
