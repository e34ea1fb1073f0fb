// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/offers/copy_source.hh"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "clients/publish/value.hh"

namespace mw::publish {
namespace {

constexpr std::int64_t MS_PER_S = 1000, NS_PER_MS = 1'000'000;

/// Changes when the file changes; empty if there is none.
std::string mark_of(const struct stat &facts) {
    return fmt::format("{} {} {} {}", facts.st_ino, facts.st_size, facts.st_mtim.tv_sec,
                       facts.st_mtim.tv_nsec);
}

}  // namespace

void CopySource::read(Watched &one) {
    auto bytes = read_file(one.file.path, offers::MOST_COPY_BYTES);
    struct stat facts{};
    if (!bytes.has_value() || ::stat(one.file.path.c_str(), &facts) != 0) {
        one.copy.reset();
        return;
    }
    const auto at =
        std::max<std::int64_t>(facts.st_mtim.tv_sec * MS_PER_S + facts.st_mtim.tv_nsec / NS_PER_MS, 0);
    one.copy = offers::Copy{{one.file.kind, offers::sha256_of_bytes(*bytes), static_cast<offers::TimeMs>(at)},
                            clean_text(std::filesystem::path(one.file.path).filename().string()),
                            std::move(*bytes)};
}

std::vector<offers::CopyFacts> CopySource::look(double now_s) {
    std::vector<offers::CopyFacts> found;
    for (Watched &one : files_) {
        struct stat facts{};
        const bool isThere = ::stat(one.file.path.c_str(), &facts) == 0;
        const std::string mark = isThere ? mark_of(facts) : "";
        if (mark != one.mark && now_s - one.read_s >= period_s_) {
            one.mark = mark;
            one.read_s = now_s;
            read(one);
        }
        if (one.copy.has_value()) {
            found.push_back(one.copy->facts);
        }
    }
    return found;
}

const offers::Copy *CopySource::find(std::string_view kind) const {
    const auto found =
        std::ranges::find(files_, kind, [](const Watched &one) { return std::string_view(one.file.kind); });
    return found != files_.end() && found->copy.has_value() ? &*found->copy : nullptr;
}

}  // namespace mw::publish
