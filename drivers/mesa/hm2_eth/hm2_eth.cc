// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_eth: Mesa boards on Ethernet.
//
//     loadrt hostmot2
//     loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=1 num_stepgens=3"
//
// Strings of several boards are separated by commas. firewall=auto or nft keeps other packets off the
// interface of a board, none leaves it open. Under the virtual clock boards are simulated:
// virtual_board=MODEL or MODEL:PHYSICS_FILE names them, or for files that are not to be changed the
// environment variable MILLWRIGHT_MESA=ADDRESS=MODEL[:PHYSICS_FILE],...
#include <cerrno>
#include <cstring>

#include "drivers/mesa/hm2_eth/ethernet_boards.hh"
#include "hal/sdk/component.hh"

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

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    if (board_rtnet != nullptr && std::strcmp(board_rtnet, "posix") != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2_eth: board_rtnet=%s: only posix is possible\n", board_rtnet);
        return -EINVAL;
    }
    comp_id = hal_init("hm2_eth");
    if (comp_id < 0) {
        return comp_id;
    }
    const int status = mw::mesa::load_ethernet_boards({.comp_id = comp_id,
                                                       .addresses = board_ip,
                                                       .configs = config,
                                                       .virtual_boards = virtual_board,
                                                       .firewall = firewall == nullptr ? "auto" : firewall});
    const int result = mw::sdk::finish(comp_id, status);
    return result < 0 ? result : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);  // no function of a board runs after this
    mw::mesa::unload_ethernet_boards(comp_id);
}
