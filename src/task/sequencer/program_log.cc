// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/sequencer/program_log.hh"

#include <cerrno>
#include <cstring>

namespace mw::task {

Result<> ProgramLog::open(const std::string &path, bool isAppending) {
    path_ = path;
    file_.reset();
    file_.reset(std::fopen(path.c_str(), isAppending ? "ae" : "we"));
    if (file_ == nullptr) {
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
