#include "runtime/gl/storage_units.h"

#include "runtime/gl/gl_functions.h"

namespace relief {

StorageUnits::StorageUnits() {
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &bound_);
    for (GLuint i = 0; i < kUnits; ++i) {
        Unit& unit = saved_[i];
        glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &unit.buffer);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &unit.offset);
        glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &unit.size);
    }
}

StorageUnits::~StorageUnits() {
    for (GLuint i = 0; i < kUnits; ++i) {
        const auto& [buffer, offset, size] = saved_[i];
        if (size > 0) {
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, static_cast<GLuint>(buffer),
                              static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size));
        } else {  // the whole buffer, or none
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, static_cast<GLuint>(buffer));
        }
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(bound_));  // binding a unit sets it too
}

GlBuffer StorageUnits::make(GLsizeiptr bytes) {
    return make(bytes, GL_STREAM_COPY);
}

GlBuffer StorageUnits::make(GLsizeiptr bytes, GLenum usage) {
    GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
    glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, usage);
    return buffer;
}

void StorageUnits::bind(GLuint unit, const GlBuffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, unit, buffer.name());
}

void StorageUnits::order() {
    // Of the two the image bit alone also keeps later stores behind earlier loads.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace relief
