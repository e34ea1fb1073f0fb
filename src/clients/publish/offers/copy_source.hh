// SPDX-License-Identifier: GPL-2.0-or-later
// Files of the machine that the shop collects. They are read, and never written.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/offers/exchange.hh"

namespace mw::publish {

/// The current version of each file. A changed file is read at most once per period, so that a file that
/// changes all the time does not load the network. All calls come from one thread.
class CopySource {
  public:
    struct File {
        std::string kind, path;
    };
    explicit CopySource(std::vector<File> files, double period_s = 60)
        : files_(files.begin(), files.end()), period_s_(period_s) {}

    /// A file that is missing, is larger than a copy may be, or cannot be read, has no entry.
    std::vector<offers::CopyFacts> look(double now_s);
    /// The last version that look() has found; null if there is none.
    const offers::Copy *find(std::string_view kind) const;

  private:
    struct Watched {
        Watched(File which) : file(std::move(which)) {}
        File file;
        std::string mark{};  ///< of the version that was read
        double read_s = -1e9;
        std::optional<offers::Copy> copy{};
    };
    void read(Watched &one);

    std::vector<Watched> files_;
    double period_s_;
};

}  // namespace mw::publish
