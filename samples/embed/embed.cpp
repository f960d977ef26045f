// Relief in a program that has an OpenGL context of its own: between the marks is all it takes, and
// runtime/README.md shows the same lines. Round them, what such a program has anyway: a context (here one
// without a window, by plain EGL), a framebuffer, and a look at whether its GL state is as it left it.
//
//     relief-embed-sample COLLIDER.relief
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

// [embed]
#include "formats/container.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/particle_renderer.h"

/// Relief reports errors as values; this program prefers exceptions.
template <class T>
T need(relief::Result<T> result) {
    if (!result) {
        throw std::runtime_error(result.error().message);
    }
    if constexpr (!std::is_void_v<T>) {
        return std::move(*result);
    }
}

/// Snow on a baked body. Every call needs your context to be current, and leaves its state as it was.
class Snow {
  public:
    explicit Snow(const char* file)
        : body(need(relief::loadCollider(file))),
          textures(need(relief::ColliderTextures::create(body))),
          particles(need(relief::ParticleSystem::create({.capacity = 10'000}))),
          body_picture(need(relief::ColliderRenderer::create(view()))),
          snow_picture(need(relief::ParticleRenderer::create(view()))) {
        need(particles.setCollider(&textures));
        need(particles.setForces({.gravity = {0.0F, -3.0F * size(), 0.0F}, .drag = 2.5F}));
        need(particles.setCollision({.restitution = 0.0F, .friction = 1.0F}));
        camera.target = body.bounds.center();
        camera.eye = camera.target + size() * glm::vec3(1.0F, 0.7F, 2.0F);
        relief::setClipPlanes(camera, body.bounds);
    }
    Snow(const Snow&) = delete;  // its parts point at each other
    Snow& operator=(const Snow&) = delete;

    void fall(const std::vector<relief::Birth>& births, float seconds) {
        need(particles.spawn(births));
        need(particles.step(seconds));
    }
    void draw(const relief::RenderTarget& target) {  // your framebuffer, with colour and depth
        need(body_picture.draw(camera, {}, target));
        snow_picture.draw(particles, camera, {.diameter = 0.01F * size()}, target);
    }
    [[nodiscard]] float size() const { return body.bounds.longestSide(); }
    [[nodiscard]] relief::ColliderView view() const { return {&textures, body.bounds, finestTexel(body)}; }

    relief::Collider body;
    relief::ColliderTextures textures;
    relief::ParticleSystem particles;
    relief::ColliderRenderer body_picture;
    relief::ParticleRenderer snow_picture;
    relief::Camera camera;
};
// [/embed]

namespace {

constexpr GLsizei kWidth = 320;
constexpr GLsizei kHeight = 240;

void check(bool good, const char* what) {
    if (!good) {
        throw std::runtime_error(what);
    }
}

/// A context without a window, current until the end of the program.
void makeContext() {
    EGLDisplay display =
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")
            ? eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
            : eglGetDisplay(EGL_DEFAULT_DISPLAY);
    check(eglInitialize(display, nullptr, nullptr) == EGL_TRUE && eglBindAPI(EGL_OPENGL_API) == EGL_TRUE,
          "no EGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display, wanted, &config, 1, &count);
    EGLContext context = eglCreateContext(display, count > 0 ? config : nullptr, EGL_NO_CONTEXT, version);
    check(context != EGL_NO_CONTEXT &&
              eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE,
          "no OpenGL 3.3 context");
}

/// A framebuffer with colour and depth, as your program has one.
relief::RenderTarget makeTarget() {
    std::array<GLuint, 2> buffers{};
    glGenRenderbuffers(2, buffers.data());
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kWidth, kHeight);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, kWidth, kHeight);
    relief::RenderTarget target{0, kWidth, kHeight};
    glGenFramebuffers(1, &target.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    check(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no framebuffer");
    return target;
}

/// State that a program relies on between its own draws.
std::map<GLenum, std::array<GLint, 4>> glState() {
    std::map<GLenum, std::array<GLint, 4>> state;
    for (const GLenum what : {GL_CURRENT_PROGRAM,
                              GL_VERTEX_ARRAY_BINDING,
                              GL_ARRAY_BUFFER_BINDING,
                              GL_UNIFORM_BUFFER_BINDING,
                              GL_PIXEL_PACK_BUFFER_BINDING,
                              GL_PIXEL_UNPACK_BUFFER_BINDING,
                              GL_DRAW_FRAMEBUFFER_BINDING,
                              GL_READ_FRAMEBUFFER_BINDING,
                              GL_RENDERBUFFER_BINDING,
                              GL_ACTIVE_TEXTURE,
                              GL_TEXTURE_BINDING_2D,
                              GL_VIEWPORT,
                              GL_SCISSOR_BOX,
                              GL_SCISSOR_TEST,
                              GL_BLEND,
                              GL_BLEND_SRC_RGB,
                              GL_BLEND_DST_RGB,
                              GL_DEPTH_TEST,
                              GL_DEPTH_FUNC,
                              GL_DEPTH_WRITEMASK,
                              GL_COLOR_WRITEMASK,
                              GL_CULL_FACE,
                              GL_CULL_FACE_MODE,
                              GL_STENCIL_TEST,
                              GL_DITHER,
                              GL_POLYGON_MODE,
                              GL_PROGRAM_POINT_SIZE,
                              GL_FRAMEBUFFER_SRGB,
                              GL_PACK_ALIGNMENT,
                              GL_UNPACK_ALIGNMENT}) {
        glGetIntegerv(what, state[what].data());
    }
    return state;
}

/// A sheet of flakes above the body; your program has better sources.
std::vector<relief::Birth> flakes(const relief::Bounds& bounds, relief::Pcg32& random) {
    std::vector<relief::Birth> births(100);
    for (relief::Birth& birth : births) {
        birth.position = {random.between(bounds.min.x, bounds.max.x),
                          bounds.max.y + 0.1F * bounds.longestSide(),
                          random.between(bounds.min.z, bounds.max.z)};
        birth.lifetime = 10.0F;
    }
    return births;
}

std::size_t coloursIn(const relief::RenderTarget& target) {
    std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kWidth) * kHeight);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    std::map<std::uint32_t, int> colours;
    for (const std::uint32_t pixel : pixels) {
        ++colours[pixel];
    }
    return colours.size();
}

void run(const char* file) {
    makeContext();
    const relief::RenderTarget target = makeTarget();
    // Settings of the program's own, which Relief's passes could not do with.
    glViewport(7, 8, 90, 100);
    glScissor(1, 2, 3, 4);
    glEnable(GL_SCISSOR_TEST);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
    glDepthFunc(GL_NEVER);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
    const auto before = glState();

    Snow snow(file);
    relief::Pcg32 random(1);
    for (int step = 0; step < 60; ++step) {
        snow.fall(flakes(snow.body.bounds, random), 1.0F / 60.0F);
    }
    snow.draw(target);

    check(glState() == before, "the GL state is not as it was");
    check(glGetError() == GL_NO_ERROR, "a GL error");
    std::printf("%u particles after %.2f s, %zu colours, GL state as it was\n", snow.particles.counts().alive,
                snow.particles.time(), coloursIn(target));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        check(argc == 2, "usage: relief-embed-sample COLLIDER.relief");
        run(argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "relief-embed-sample: error: %s\n", error.what());
        return 1;
    }
}
