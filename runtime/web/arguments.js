// SPDX-License-Identifier: Apache-2.0
// Validates the arguments of the API.
import { check } from "./fetch.js";

/** Validates an array or typed array whose length is a multiple of `each`, and returns it as a Float32Array. */
export function numbers(what, values, each) {
    check(Array.isArray(values) || ArrayBuffer.isView(values),
          `${what} must be an array of numbers, ${each} per item`);
    const list = values instanceof Float32Array ? values : Float32Array.from(values);
    check(list.length % each === 0,
          `${what}: the number of values, ${list.length}, is not a multiple of ${each}`);
    return list;
}

export function checkFinite(what, list) {
    const at = list.findIndex((one) => !Number.isFinite(one));
    check(at < 0, `${what}: number ${at} is ${list[at]}`);
    return list;
}

export function matrix(what, value) {
    const list = value?.elements ?? value; // a three.js Matrix4
    check((Array.isArray(list) || ArrayBuffer.isView(list)) && list.length === 16,
          `draw() needs ${what}: 16 numbers in column-major order`);
    return checkFinite(what, Float32Array.from(list));
}

export function pixels(what, value) {
    check(Number.isInteger(value) && value >= 0,
          `draw(): the ${what} is ${value}; use a number of pixels, 0 or more`);
    return value;
}

export function index(what, value, count) {
    check(Number.isInteger(value) && value >= 0 && value < count,
          `there is no ${what} ${value}; there are ${count}, numbered from 0`);
    return value;
}
