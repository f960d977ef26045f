// For programs, at the start of main(): a signal that ends them leaves no temporary file behind.
#pragma once

namespace relief {

/// From here on SIGINT, SIGTERM, SIGHUP and SIGQUIT first remove the temporary files of outputs and then end
/// the program, as they would have done anyway: a shell sees 128 + n. One that is ignored, as by nohup, stays
/// ignored. SIGXFSZ and SIGPIPE are ignored: a write that fails is an error with a line to say (EFBIG,
/// EPIPE).
void endCleanlyOnSignals();

}  // namespace relief
