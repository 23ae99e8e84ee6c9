// Spheres: for each a square that covers it, in which every pixel meets the sphere with its ray, or nothing.
const SPHERE_NUMBERS = 13;

class Spheres {
  constructor(gl) {
    this.gl = gl;
    this.shader = makeProgram(gl, `
      layout(location = 0) in vec4 ball;      // centre, radius
      layout(location = 1) in vec4 tint;
      layout(location = 2) in vec4 turned;    // orientation
      layout(location = 3) in float shine;    // a contact's flash
      uniform mat4 view, projection;
      out vec3 ray;
      flat out vec4 sphere, colour, orientation;
      flat out float flash;
      void main() {
        vec3 middle = (view * vec4(ball.xyz, 1.0)).xyz;
        float away = length(middle), radius = ball.w;
        vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
        vec3 to = middle / away;
        vec3 across = normalize(cross(to, abs(to.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
        // The cone from the eye around the sphere is a little wider than the sphere.
        float wide = radius * away / sqrt(max(away * away - radius * radius, 1e-9)) * 1.05;
        ray = middle + (across * corner.x + cross(to, across) * corner.y) * wide;
        sphere = vec4(middle, radius);
        colour = tint; orientation = turned; flash = shine;
        gl_Position = away > radius * 1.01 ? projection * vec4(ray, 1.0) : vec4(2, 2, 2, 1);
      }`, `
      in vec3 ray;
      flat in vec4 sphere, colour, orientation;
      flat in float flash;
      uniform mat4 view, projection;
      uniform vec3 light;
      uniform float striped;
      out vec4 pixel;
      vec3 turnedBack(vec3 v) { return v + 2.0 * cross(cross(v, orientation.xyz) + orientation.w * v, orientation.xyz); }
      void main() {
        vec3 to = normalize(ray);
        float along = dot(to, sphere.xyz);
        // The square of the distance from the centre to the ray: from a difference of vectors, as that of squares cancels.
        vec3 miss = sphere.xyz - along * to;
        float inside = sphere.w * sphere.w - dot(miss, miss);
        float edge = clamp(inside / max(fwidth(inside), 1e-20) + 0.5, 0.0, 1.0);
        if (edge <= 0.0) discard;
        vec3 hit = to * (along - sqrt(max(inside, 0.0)));
        vec3 normal = normalize(hit - sphere.xyz);
        mat3 toWorld = transpose(mat3(view));
        vec3 upright = toWorld * normal;
        vec3 paint = colour.rgb;
        if (striped > 0.5) {
          vec3 own = turnedBack(upright);
          vec3 side = smoothstep(-0.03, 0.03, own) * 2.0 - 1.0;
          paint = mix(paint * 0.5 + 0.03, paint, side.x * side.y * side.z * 0.5 + 0.5);
        }
        float lit = max(dot(upright, light), 0.0);
        vec3 halfway = normalize(toWorld * -to + light);
        float sparkle = pow(max(dot(upright, halfway), 0.0), 48.0) * 0.35;
        vec3 seen = paint * (0.34 + 0.16 * upright.z + 0.72 * lit) + sparkle;
        seen = mix(seen, vec3(1.0, 0.93, 0.62) * (0.7 + 0.3 * lit), flash * flash * 0.85);
        vec4 clip = projection * vec4(hit, 1.0);
        gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
        pixel = vec4(pow(seen, vec3(0.8)), colour.a * edge);
      }`);
    this.buffers = makeArray(gl, [4, 4, 4, 1], true);
  }

  /** Draws spheres of thirteen numbers each. */
  draw(numbers, camera, light, striped) {
    const { gl, shader: { program, uniforms } } = this;
    gl.useProgram(program);
    gl.bindVertexArray(this.buffers.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    gl.uniformMatrix4fv(uniforms.view, false, camera.view);
    gl.uniformMatrix4fv(uniforms.projection, false, camera.projection);
    gl.uniform3fv(uniforms.light, light);
    gl.uniform1f(uniforms.striped, striped ? 1 : 0);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, numbers.length / SPHERE_NUMBERS);
  }
}
