// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <latch>
#include <string>

#include "machine/task/sequencer/program_log.hh"

namespace mw::task::test {

/// A disk that blocks until the test releases it.
class HungDisk final : public LogDisk {
  public:
    Result<int> open(const std::string &path, bool appending, const Confinement *confinement) override {
        wait();
        return LogDisk::open(path, appending, confinement);
    }
    Result<> write(int file, std::string_view text) override {
        wait();
        return LogDisk::write(file, text);
    }
    void release() { isReleased_.count_down(); }

  private:
    void wait() { isReleased_.wait(); }
    std::latch isReleased_{1};
};

}  // namespace mw::task::test
