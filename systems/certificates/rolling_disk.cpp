#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/rolling_disk.hpp>

template std::vector<lagroid::laws::LawReport> lagroid::laws::certificate(
    const lagroid::RollingDisk&, const std::function<lagroid::State<lagroid::RollingDisk::GroupoidType>()>&);
