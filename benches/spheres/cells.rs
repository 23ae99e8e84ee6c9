//! A cell list, the usual way to find which spheres of a set touch: cells as wide as the largest sphere, spheres sorted
//! by cell, and 16 distances at a time where the processor has AVX-512, or 8 where it has AVX2 and FMA.
//!
//! It decides in binary32 by squares, so it is a little less exact than the kernel.

/// Spheres by cell, as a structure of arrays. Sixteen empty ones follow, so that the last loads stay inside.
pub struct Cells {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    r: Vec<f32>,
    number: Vec<u32>,
    /// The first sphere of each cell; x varies fastest.
    begin: Vec<u32>,
    low: [f32; 3],
    per_length: f32,
    counts: [i32; 3],
}

/// More cells than this cost more than they save.
const MOST_CELLS: f64 = 4e6;

impl Cells {
    /// Sorts spheres x y z r into cells that are as wide as two spheres can be apart and touch.
    pub fn new(spheres: &[[f32; 4]], reach: f32) -> Self {
        let edge = |pick: fn(f32, f32) -> f32, begin: f32| -> [f32; 3] {
            std::array::from_fn(|axis| spheres.iter().map(|sphere| sphere[axis]).fold(begin, pick))
        };
        let (low, high) = (edge(f32::min, f32::INFINITY), edge(f32::max, f32::NEG_INFINITY));
        let volume: f64 = (0..3).map(|axis| f64::from(high[axis] - low[axis])).product();
        let width = (f64::from(reach) * (1.0 + 1e-6)).max((volume / MOST_CELLS).cbrt()) as f32;
        let per_length = 1.0 / width;
        let counts: [i32; 3] = std::array::from_fn(|axis| ((high[axis] - low[axis]) * per_length) as i32 + 1);
        let size = spheres.len() + 16;
        let mut cells = Self {
            x: vec![f32::NAN; size],
            y: vec![f32::NAN; size],
            z: vec![f32::NAN; size],
            r: vec![f32::NAN; size],
            number: vec![0; size],
            begin: vec![0; (counts[0] * counts[1] * counts[2]) as usize + 1],
            low,
            per_length,
            counts,
        };
        let places: Vec<u32> = spheres.iter().map(|sphere| cells.index(cells.cell(sphere)) as u32).collect();
        places.iter().for_each(|place| cells.begin[*place as usize + 1] += 1);
        for cell in 1..cells.begin.len() {
            cells.begin[cell] += cells.begin[cell - 1];
        }
        let mut next = cells.begin.clone();
        for ((place, number), [x, y, z, r]) in places.iter().zip(0..).zip(spheres) {
            let at = next[*place as usize] as usize;
            next[*place as usize] += 1;
            (cells.x[at], cells.y[at], cells.z[at], cells.r[at], cells.number[at]) = (*x, *y, *z, *r, number);
        }
        cells
    }

    #[inline(always)]
    fn cell(&self, sphere: &[f32; 4]) -> [i32; 3] {
        std::array::from_fn(|axis| ((sphere[axis] - self.low[axis]) * self.per_length).floor() as i32)
    }

    #[inline(always)]
    fn index(&self, [x, y, z]: [i32; 3]) -> usize {
        ((z * self.counts[1] + y) * self.counts[0] + x) as usize
    }

    /// The spheres in the cells from x − 1 to x + 1 of a row of cells; none if the row is outside.
    #[inline(always)]
    fn row(&self, [x, y, z]: [i32; 3]) -> [usize; 2] {
        let [across, up, deep] = self.counts;
        if y < 0 || y >= up || z < 0 || z >= deep || x < -1 || x > across {
            return [0, 0];
        }
        let (first, last) = ((x - 1).max(0), (x + 1).min(across - 1));
        [self.begin[self.index([first, y, z])] as usize, self.begin[self.index([last, y, z]) + 1] as usize]
    }

    /// Pairs of this set that touch.
    pub fn pairs(&self, found: &mut Vec<[u32; 2]>) {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor was found to have AVX-512.
            return unsafe { self.pairs_avx512(found) };
        }
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor was found to have both.
            return unsafe { self.pairs_avx2(found) };
        }
        self.each_pair(found, |range, sphere, number, found| self.portable(range, sphere, number, found));
    }

    /// Pairs of one of this set and one of `others` that touch.
    pub fn pairs_with(&self, others: &[[f32; 4]], found: &mut Vec<[u32; 2]>) {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor was found to have AVX-512.
            return unsafe { self.pairs_with_avx512(others, found) };
        }
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor was found to have both.
            return unsafe { self.pairs_with_avx2(others, found) };
        }
        self.each_pair_with(others, found, |range, sphere, number, found| self.portable(range, sphere, number, found));
    }

    #[inline(always)]
    fn each_pair(&self, found: &mut Vec<[u32; 2]>, test: impl Fn([usize; 2], [f32; 4], u32, &mut Vec<[u32; 2]>)) {
        for z in 0..self.counts[2] {
            for y in 0..self.counts[1] {
                for x in 0..self.counts[0] {
                    let cell = self.index([x, y, z]);
                    let (begin, end) = (self.begin[cell] as usize, self.begin[cell + 1] as usize);
                    if begin == end {
                        continue;
                    }
                    let here = self.row([x, y, z])[1];
                    let rows = [[x, y + 1, z], [x, y - 1, z + 1], [x, y, z + 1], [x, y + 1, z + 1]];
                    let rows = rows.map(|row| self.row(row));
                    for at in begin..end {
                        let sphere = [self.x[at], self.y[at], self.z[at], self.r[at]];
                        test([at + 1, here], sphere, self.number[at], found);
                        rows.iter().for_each(|row| test(*row, sphere, self.number[at], found));
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn each_pair_with(
        &self,
        others: &[[f32; 4]],
        found: &mut Vec<[u32; 2]>,
        test: impl Fn([usize; 2], [f32; 4], u32, &mut Vec<[u32; 2]>),
    ) {
        for (number, sphere) in (0..).zip(others) {
            let [x, y, z] = self.cell(sphere);
            for dz in -1..=1 {
                for dy in -1..=1 {
                    test(self.row([x, y + dy, z + dz]), *sphere, number, found);
                }
            }
        }
    }

    #[inline(always)]
    fn portable(&self, [begin, end]: [usize; 2], [x, y, z, r]: [f32; 4], number: u32, found: &mut Vec<[u32; 2]>) {
        for at in begin..end {
            let (dx, dy, dz, sum) = (self.x[at] - x, self.y[at] - y, self.z[at] - z, self.r[at] + r);
            if dx * dx + dy * dy + dz * dz <= sum * sum {
                found.push([self.number[at], number]);
            }
        }
    }

    /// Of the spheres from `begin` to `end`, those whose bits are set touch the one with this number.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn push(&self, [begin, end]: [usize; 2], mut touching: u32, number: u32, found: &mut Vec<[u32; 2]>) {
        if end - begin < 16 {
            touching &= (1 << (end - begin)) - 1;
        }
        while touching != 0 {
            found.push([self.number[begin + touching.trailing_zeros() as usize], number]);
            touching &= touching - 1;
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn pairs_avx512(&self, found: &mut Vec<[u32; 2]>) {
        self.each_pair(found, |range, sphere, number, found| self.wide16(range, sphere, number, found));
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn pairs_with_avx512(&self, others: &[[f32; 4]], found: &mut Vec<[u32; 2]>) {
        self.each_pair_with(others, found, |range, sphere, n, found| self.wide16(range, sphere, n, found));
    }

    #[cfg(target_arch = "x86_64")]
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn wide16(&self, [begin, end]: [usize; 2], values: [f32; 4], number: u32, found: &mut Vec<[u32; 2]>) {
        use std::arch::x86_64::*;
        let value = values.map(|value| _mm512_set1_ps(value));
        let mut at = begin;
        while at < end {
            // SAFETY: sixteen empty spheres follow the last one.
            let load = |column: &Vec<f32>| unsafe { _mm512_loadu_ps(column.as_ptr().add(at)) };
            let [dx, dy, dz] = [
                _mm512_sub_ps(load(&self.x), value[0]),
                _mm512_sub_ps(load(&self.y), value[1]),
                _mm512_sub_ps(load(&self.z), value[2]),
            ];
            let sum = _mm512_add_ps(load(&self.r), value[3]);
            let squared = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
            let touch = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(squared, _mm512_mul_ps(sum, sum));
            self.push([at, end], u32::from(touch), number, found);
            at += 16;
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn pairs_avx2(&self, found: &mut Vec<[u32; 2]>) {
        self.each_pair(found, |range, sphere, number, found| self.wide8(range, sphere, number, found));
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn pairs_with_avx2(&self, others: &[[f32; 4]], found: &mut Vec<[u32; 2]>) {
        self.each_pair_with(others, found, |range, sphere, n, found| self.wide8(range, sphere, n, found));
    }

    #[cfg(target_arch = "x86_64")]
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn wide8(&self, [begin, end]: [usize; 2], values: [f32; 4], number: u32, found: &mut Vec<[u32; 2]>) {
        use std::arch::x86_64::*;
        let value = values.map(|value| _mm256_set1_ps(value));
        let mut at = begin;
        while at < end {
            // SAFETY: at least eight empty spheres follow the last one.
            let load = |column: &Vec<f32>| unsafe { _mm256_loadu_ps(column.as_ptr().add(at)) };
            let [dx, dy, dz] = [
                _mm256_sub_ps(load(&self.x), value[0]),
                _mm256_sub_ps(load(&self.y), value[1]),
                _mm256_sub_ps(load(&self.z), value[2]),
            ];
            let sum = _mm256_add_ps(load(&self.r), value[3]);
            let squared = _mm256_fmadd_ps(dz, dz, _mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dx, dx)));
            let touch = _mm256_cmp_ps::<_CMP_LE_OQ>(squared, _mm256_mul_ps(sum, sum));
            self.push([at, end], _mm256_movemask_ps(touch) as u32, number, found);
            at += 8;
        }
    }
}
