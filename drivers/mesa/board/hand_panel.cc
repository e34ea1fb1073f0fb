// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/hand_panel.hh"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace mw::mesa::board {

Result<std::shared_ptr<HandPanel>> HandPanel::open(const std::string &path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) {
        return fail("The panel '" + path + "' cannot be opened: " + std::strerror(errno) + ".");
    }
    const bool sized = ::ftruncate(file, sizeof(HandPanelPage)) == 0;
    void *const page =
        sized ? ::mmap(nullptr, sizeof(HandPanelPage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)
              : MAP_FAILED;
    ::close(file);
    if (page == MAP_FAILED) {
        return fail("The panel '" + path + "' cannot be mapped: " + std::strerror(errno) + ".");
    }
    return std::shared_ptr<HandPanel>(new HandPanel(static_cast<HandPanelPage *>(page)));
}

HandPanel::~HandPanel() {
    ::munmap(page_, sizeof(HandPanelPage));
}

}  // namespace mw::mesa::board
