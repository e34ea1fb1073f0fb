// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/sequencer/program_log.hh"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/atomic_file.hh"

namespace mw::task {

Result<> ProgramLog::open(const std::string &path, bool isAppending, const Confinement *confinement) {
    path_ = path;
    file_.reset();
    const Result<int> opened =
        confinement != nullptr
            ? open_log(*confinement, path, isAppending)
            : open_regular_file(path, O_WRONLY | O_CREAT | (isAppending ? O_APPEND : O_TRUNC));
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    file_.reset(::fdopen(*opened, isAppending ? "a" : "w"));
    if (file_ == nullptr) {
        ::close(*opened);
        return fail("cannot write " + path + ": " + std::strerror(errno));
    }
    std::setvbuf(file_.get(), nullptr, _IOLBF, BUFSIZ);
    return {};
}

Result<> ProgramLog::write(const std::string &line) {
    if (file_ != nullptr && std::fputs((line + '\n').c_str(), file_.get()) < 0) {
        file_.reset();
        return fail("cannot write " + path_ + ": " + std::strerror(errno));
    }
    return {};
}

}  // namespace mw::task
