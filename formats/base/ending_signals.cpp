#include "formats/base/ending_signals.h"

#include <csignal>

#include "formats/base/temporary_file.h"

namespace relief {
namespace {

void end(int number) {
    removeTemporaryFiles();
    // SA_RESETHAND has put back what the signal does by itself, and SA_NODEFER lets it through.
    ::raise(number);
}

}  // namespace

void endCleanlyOnSignals() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        struct sigaction before {};
        if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
            struct sigaction action {};
            action.sa_handler = end;
            action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
            ::sigaction(number, &action, nullptr);
        }
    }
    ::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace relief
