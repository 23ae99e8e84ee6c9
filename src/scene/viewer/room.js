// The floor and the walls with a grid on them, and the shadow of every sphere on the ground.
class Room {
  constructor(gl) {
    this.gl = gl;
    this.planes = makeProgram(gl, `
      layout(location = 0) in vec3 corner;
      layout(location = 1) in vec2 on;
      uniform mat4 view, projection;
      out vec3 place;
      out vec2 grid;
      void main() { place = corner; grid = on; gl_Position = projection * view * vec4(corner, 1.0); }`, `
      in vec3 place;
      in vec2 grid;
      uniform vec3 middle, ground, line;
      uniform float cell, reach, strength;
      out vec4 pixel;
      void main() {
        vec2 at = grid / cell, wide = fwidth(at) * 1.2;
        vec2 near = abs(fract(at - 0.5) - 0.5) / max(wide, 1e-6);
        float ruled = (1.0 - min(min(near.x, near.y), 1.0)) * clamp(1.2 - max(wide.x, wide.y) * 2.0, 0.0, 1.0);
        float fade = reach > 0.0 ? 1.0 - smoothstep(0.35, 1.0, length(place.xy - middle.xy) / reach) : 1.0;
        pixel = vec4(mix(ground, line, ruled), fade * mix(strength, 1.0, ruled * 0.6));
      }`);
    this.shadows = makeProgram(gl, `
      layout(location = 0) in vec4 ball;
      uniform mat4 view, projection;
      uniform vec3 light;
      uniform float height;
      out vec2 at;
      out float dark;
      void main() {
        at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
        float above = max(ball.z - height, 0.0);
        // What is high casts a wider and fainter shadow.
        float soft = 1.0 + 0.25 * above / ball.w;
        dark = 0.5 / (soft * soft) * step(0.0, ball.z - height);
        vec2 foot = ball.xy - light.xy / light.z * above;
        gl_Position = projection * view * vec4(foot + at * ball.w * soft * 1.25, height, 1.0);
      }`, `
      in vec2 at;
      in float dark;
      out vec4 pixel;
      void main() { pixel = vec4(0, 0, 0, dark * (1.0 - smoothstep(0.3, 1.0, length(at)))); }`);
    this.plane = makeArray(gl, [3, 2], false);
    this.feet = makeArray(gl, [4], true);
  }

  draw(camera, light, balls, theme) {
    const { floor, walls } = picture, reach = camera.radius * 6;
    if (floor !== null) {
      const [x, y] = camera.target, far = [x - reach, y - reach, x + reach, y + reach];
      this.panel(2, floor, [[far[0], far[1]], [far[2], far[3]]], camera, theme, reach, 1);
    }
    if (walls) {
      for (let axis = 0; axis < 3; axis++) {
        const others = [0, 1, 2].filter((other) => other !== axis);
        const corners = walls.map((corner) => others.map((other) => corner[other]));
        // Only walls that the eye sees from inside: the near ones would hide the bodies.
        if (camera.eye[axis] > walls[0][axis]) this.panel(axis, walls[0][axis], corners, camera, theme, 0, 0.75);
        if (camera.eye[axis] < walls[1][axis]) this.panel(axis, walls[1][axis], corners, camera, theme, 0, 0.75);
      }
    }
    const height = floor !== null ? floor : walls ? walls[0][2] : null;
    if (height !== null && camera.eye[2] > height) this.shade(height, camera, light, balls);
  }

  /** A rectangle across an axis, at a height on it, from one corner to another. */
  panel(axis, height, [low, high], camera, theme, reach, strength) {
    const { gl, planes: { program, uniforms } } = this, others = [0, 1, 2].filter((other) => other !== axis);
    const numbers = [];
    for (const [u, v] of [[low[0], low[1]], [high[0], low[1]], [low[0], high[1]], [high[0], high[1]]]) {
      const corner = [0, 0, 0];
      [corner[axis], corner[others[0]], corner[others[1]]] = [height, u, v];
      numbers.push(...corner, u, v);
    }
    gl.useProgram(program);
    gl.bindVertexArray(this.plane.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.plane.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.DYNAMIC_DRAW);
    gl.uniformMatrix4fv(uniforms.view, false, camera.view);
    gl.uniformMatrix4fv(uniforms.projection, false, camera.projection);
    gl.uniform3fv(uniforms.middle, camera.target);
    gl.uniform3fv(uniforms.ground, theme.ground);
    gl.uniform3fv(uniforms.line, theme.line);
    gl.uniform1f(uniforms.cell, this.cell);
    gl.uniform1f(uniforms.reach, reach);
    gl.uniform1f(uniforms.strength, strength);
    gl.depthMask(false);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.depthMask(true);
  }

  shade(height, camera, light, balls) {
    const { gl, shadows: { program, uniforms } } = this;
    gl.useProgram(program);
    gl.bindVertexArray(this.feet.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.feet.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, balls, gl.DYNAMIC_DRAW);
    gl.uniformMatrix4fv(uniforms.view, false, camera.view);
    gl.uniformMatrix4fv(uniforms.projection, false, camera.projection);
    gl.uniform3fv(uniforms.light, light);
    gl.uniform1f(uniforms.height, height);
    gl.disable(gl.DEPTH_TEST);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, balls.length / 4);
    gl.enable(gl.DEPTH_TEST);
  }

  /** The side of a square of the grid: some two radii, rounded to 1, 2 or 5. */
  get cell() {
    if (!this.side) {
      const wanted = Math.max(2 * Math.max(...picture.radii.slice(0, 1000)), picture.span / 40);
      const power = 10 ** Math.floor(Math.log10(wanted));
      this.side = [1, 2, 5, 10].map((n) => n * power).find((side) => side >= wanted * 0.999);
    }
    return this.side;
  }
}
