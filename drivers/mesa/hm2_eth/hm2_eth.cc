// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_eth: Mesa boards on Ethernet.
//
//     loadrt hostmot2
//     loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=1 num_stepgens=3"
//
// Strings of several boards are separated by commas. firewall=auto or nft blocks other packets on the
// interface of a board, none does not. Under the virtual clock boards are simulated: virtual_board=MODEL or
// MODEL:PHYSICS_FILE selects them; for files that must not be changed the environment variable
// MILLWRIGHT_MESA=ADDRESS=MODEL[:PHYSICS_FILE],...
#include <cerrno>
#include <cstring>

#include "drivers/mesa/hm2_eth/ethernet_boards.hh"
#include "hal/sdk/module.hh"

namespace {

using mw::mesa::MAX_ETHERNET_BOARDS;

char *board_ip[MAX_ETHERNET_BOARDS];
char *config[MAX_ETHERNET_BOARDS];
char *virtual_board[MAX_ETHERNET_BOARDS];
char *firewall = nullptr;
char *board_rtnet = nullptr;
int debug = 0;
RTAPI_MP_ARRAY_STRING(board_ip, MAX_ETHERNET_BOARDS, "addresses of the boards");
RTAPI_MP_ARRAY_STRING(config, MAX_ETHERNET_BOARDS, "which modules of each board are used");
RTAPI_MP_ARRAY_STRING(virtual_board, MAX_ETHERNET_BOARDS, "models of the boards under the virtual clock");
RTAPI_MP_STRING(firewall, "auto, nft or none");
RTAPI_MP_STRING(board_rtnet, "posix: the sockets of Linux");
RTAPI_MP_INT(debug, "accepted for files of LinuxCNC; failures are always counted");

struct Boards {
    int comp_id = 0;

    int load(int id) noexcept {
        comp_id = id;
        if (board_rtnet != nullptr && std::strcmp(board_rtnet, "posix") != 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "hm2_eth: board_rtnet=%s: only posix is possible\n", board_rtnet);
            return -EINVAL;
        }
        return mw::mesa::load_ethernet_boards({.comp_id = id,
                                               .addresses = board_ip,
                                               .configs = config,
                                               .virtual_boards = virtual_board,
                                               .firewall = firewall == nullptr ? "auto" : firewall});
    }
    void end() noexcept { mw::mesa::unload_ethernet_boards(comp_id); }
};

}  // namespace

MW_COMPONENT_DEVICE(Boards, "hm2_eth");
