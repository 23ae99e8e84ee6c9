//! The Levenberg-Marquardt method, for a few positive parameters.

use nalgebra::{DMatrix, DVector};

/// The maximum number of steps. Some twenty are usual.
const STEPS: u32 = 200;

/// The positive parameters that minimise the sum of the squares of `residuals`, starting from `start`. They are changed
/// by factors, so they stay positive.
pub fn fit(start: &[f64], residuals: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let at = |logs: &DVector<f64>| {
        let values: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
        DVector::from_vec(residuals(&values))
    };
    let mut logs = DVector::from_iterator(start.len(), start.iter().map(|value| value.ln()));
    let mut now = at(&logs);
    let mut damping = 1e-2;
    for _ in 0..STEPS {
        let slopes = slopes(&logs, &now, at);
        let normal = slopes.transpose() * &slopes;
        let gradient = slopes.transpose() * &now;
        let damped = &normal + DMatrix::identity(start.len(), start.len()) * damping;
        let Some(step) = damped.cholesky().map(|factor| factor.solve(&gradient)) else { break };
        let next = &logs - &step;
        let there = at(&next);
        if there.norm_squared() < now.norm_squared() {
            (logs, now) = (next, there);
            damping = (damping / 3.0_f64).max(1e-9);
        } else {
            damping *= 4.0;
        }
        if damping > 1e9 {
            break;
        }
    }
    logs.iter().map(|log| log.exp()).collect()
}

fn slopes(logs: &DVector<f64>, now: &DVector<f64>, at: impl Fn(&DVector<f64>) -> DVector<f64>) -> DMatrix<f64> {
    const SMALL: f64 = 1e-4;
    let columns: Vec<DVector<f64>> = (0..logs.len())
        .map(|index| {
            let mut moved = logs.clone();
            moved[index] += SMALL;
            (at(&moved) - now) / SMALL
        })
        .collect();
    DMatrix::from_columns(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_the_parameters_that_made_the_data() {
        // The larger of two straight lines, which has a kink like the delay of a path.
        let model = |p: &[f64], x: f64| (p[0] + p[1] * x).max(p[2] * x);
        let wanted = [1.0, 0.05, 0.11];
        let residuals =
            |p: &[f64]| (1..40).map(f64::from).map(|x| model(p, x) / model(&wanted, x) - 1.0).collect::<Vec<_>>();
        for (found, wanted) in fit(&[0.5, 0.1, 0.1], residuals).iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-3, "{found} for {wanted}");
        }
    }
}
