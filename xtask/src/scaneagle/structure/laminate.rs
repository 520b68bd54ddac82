//! A laminate as one orthotropic plate.
//!
//! CalculiX 2.20 does not take layered shells and springs in one model. The plate has the
//! layers' stiffness in its plane and, over all directions, in bending:
//!
//! $$ A_i = \sum E_i t,\quad D_i = \sum E_i \int z^2\,\mathrm dz,\quad
//!    t_e = \sqrt{12 \sum D_i / \sum A_i},\quad E_i' = A_i / t_e $$
//!
//! with i along, across and shear. A core of shear modulus G and thickness c in a plate of
//! thickness T gives $G T^2/(c\,t_e)$ across the thickness.

use std::collections::BTreeMap;

use super::table::{Layers, Material};

/// One plate that stands for all layers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Laminate {
    /// m
    pub(super) thickness: f64,
    /// N/m²: along, across, shear in its plane, shear across the thickness
    pub(super) moduli: [f64; 4],
    pub(super) poisson: f64,
    /// kg/m²
    pub(super) area_density: f64,
}

impl Laminate {
    /// Of layers whose materials are all there.
    pub(super) fn of(layers: &Layers, materials: &BTreeMap<String, Material>) -> Self {
        let total: f64 = layers.iter().map(|(_, thickness)| thickness).sum();
        let mut low = -total / 2.0;
        let (mut membrane, mut bending) = ([0.0; 3], 0.0);
        let (mut poisson, mut area_density, mut core) = (0.0, 0.0, None);
        for (name, thickness) in layers {
            let material = &materials[name];
            let high = low + thickness;
            let cube = (high * high * high - low * low * low) / 3.0;
            let moduli = [material.along, material.across, material.shear];
            for (sum, modulus) in membrane.iter_mut().zip(moduli) {
                *sum += modulus * thickness;
                bending += modulus * cube;
            }
            poisson += material.poisson * material.along * thickness;
            area_density += material.density * thickness;
            if material.core {
                core = Some((material.shear, *thickness));
            }
            low = high;
        }
        let thickness = (12.0 * bending / membrane.iter().sum::<f64>()).sqrt();
        let [along, across, shear] = membrane.map(|sum| sum / thickness);
        let transverse = core.map_or(shear, |(modulus, depth)| {
            modulus * total * total / (depth * thickness)
        });
        Self {
            thickness,
            moduli: [along, across, shear, transverse],
            poisson: poisson / membrane[0],
            area_density,
        }
    }
}
