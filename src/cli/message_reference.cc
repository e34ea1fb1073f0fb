// SPDX-License-Identifier: GPL-2.0-or-later
// message_reference: prints docs/messages.md. A tool of the build, not installed.
#include <cstdio>

#include "msgs/reference.hh"

int main() {
    return std::fputs(mw::msgs::reference_page().c_str(), stdout) < 0 ? 1 : 0;
}
