// PassState in a browser. The state belongs to a page whose textures and buffers have no names here, so that it is kept as
// the objects themselves.
#include "runtime/gl/pass_state.h"

extern "C" void relief_js_save_state(int units);

extern "C" void relief_js_restore_state();

namespace relief {

struct PassState::Saved {};

PassState::PassState() {
    relief_js_save_state(kUnits);
}

PassState::~PassState() {
    relief_js_restore_state();
}

}  // namespace relief
