#include "runtime/gl/gpu_timer.h"

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {
namespace {

// The extension of GL ES has entry points of its own; the numbers of the enumerations are the same.
GLint queryProperty(bool gles, GLenum what) {
    GLint value = 0;
    (gles ? glGetQueryivEXT : glGetQueryiv)(GL_TIME_ELAPSED, what, &value);
    return value;
}

}  // namespace

GpuTimer::GpuTimer() : gles_(isGles()) {
    measures_gpu_ = gles_ ? epoxy_has_gl_extension("GL_EXT_disjoint_timer_query")
                          : epoxy_gl_version() >= 33 || epoxy_has_gl_extension("GL_ARB_timer_query");
    measures_gpu_ = measures_gpu_ && queryProperty(gles_, GL_QUERY_COUNTER_BITS) > 0;
    if (!measures_gpu_) {
        return;
    }
    (gles_ ? glGenQueriesEXT : glGenQueries)(kQueries, queries_.data());
    if (gles_) {
        GLint disjoint = 0;
        glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);  // reading it forgets what was before
    }
}

GpuTimer::~GpuTimer() {
    if (measures_gpu_) {
        (gles_ ? glDeleteQueriesEXT : glDeleteQueries)(kQueries, queries_.data());
    }
}

void GpuTimer::begin(Stage stage) {
    stage_ = stage;
    if (measures_gpu_) {
        if (outstanding_ == kQueries) {
            collect();
        }
        open_ = outstanding_ < kQueries && queryProperty(gles_, GL_CURRENT_QUERY) == 0;
        if (open_) {
            const auto next = static_cast<std::size_t>((oldest_ + outstanding_) % kQueries);
            stages_[next] = stage;
            (gles_ ? glBeginQueryEXT : glBeginQuery)(GL_TIME_ELAPSED, queries_[next]);
        }
    }
    stage_watch_ = Stopwatch();
}

void GpuTimer::end() {
    StageTime& time = times_[static_cast<std::size_t>(stage_)];
    ++time.runs;
    time.cpu_ms += stage_watch_.ms();
    if (open_) {
        (gles_ ? glEndQueryEXT : glEndQuery)(GL_TIME_ELAPSED);
        ++outstanding_;
        open_ = false;
    }
}

const StageTimes& GpuTimer::times() {
    if (measures_gpu_) {
        collect();
    }
    return times_;
}

void GpuTimer::collect() {
    int arrived = 0;
    std::array<GLuint64, kQueries> nanoseconds{};
    for (; arrived < outstanding_; ++arrived) {
        const GLuint query = queries_[static_cast<std::size_t>((oldest_ + arrived) % kQueries)];
        GLuint available = GL_FALSE;
        (gles_ ? glGetQueryObjectuivEXT : glGetQueryObjectuiv)(query, GL_QUERY_RESULT_AVAILABLE, &available);
        if (available == GL_FALSE) {
            break;  // results come in order
        }
        (gles_ ? glGetQueryObjectui64vEXT : glGetQueryObjectui64v)(
            query, GL_QUERY_RESULT, &nanoseconds[static_cast<std::size_t>(arrived)]);
    }
    // The clock has jumped (the GPU changed its frequency): all results so far and the running ones are
    // worthless.
    GLint disjoint = 0;
    if (gles_) {
        glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
    }
    for (int i = 0; i < arrived && disjoint == 0; ++i) {
        StageTime& time = times_[static_cast<std::size_t>(stages_[static_cast<std::size_t>(oldest_)])];
        ++time.gpu_runs;
        time.gpu_ms += 1e-6 * static_cast<double>(nanoseconds[static_cast<std::size_t>(i)]);
        oldest_ = (oldest_ + 1) % kQueries;
        --outstanding_;
    }
    if (disjoint != 0) {
        oldest_ = (oldest_ + outstanding_) % kQueries;
        outstanding_ = 0;
    }
}

}  // namespace relief
