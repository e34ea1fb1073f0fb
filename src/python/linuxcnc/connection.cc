// SPDX-License-Identifier: GPL-2.0-or-later
#include "python/linuxcnc/connection.hh"

#include "python/linuxcnc/module.hh"

namespace mw::python {

client::Viewer &View::viewer() {
    if (!viewer_.has_value()) {
        auto joined = client::Viewer::attach(machine_instance());
        if (!joined.has_value()) {
            throw_error(joined.error().str());
        }
        viewer_.emplace(std::move(*joined));
    }
    return *viewer_;
}

void View::check_alive() {
    constexpr std::chrono::milliseconds PATIENCE{100};
    const auto now = std::chrono::steady_clock::now();
    const std::uint64_t cycle = viewer().status().cycle;
    if (cycle != cycle_) {
        cycle_ = cycle;
        seen_ = now;
        return;
    }
    if (now - seen_ < PATIENCE) {
        return;
    }
    seen_ = now;
    if (!viewer_->isMachineAlive()) {
        viewer_.reset();  // the next call finds a machine that was started meanwhile
        throw_error("the machine is no longer running");
    }
}

client::Client connect_client() {
    auto client = client::Client::connect(machine_instance());
    if (!client.has_value()) {
        throw_error(client.error().str());
    }
    return std::move(*client);
}

}  // namespace mw::python
