//! Mirrored and refracted directions: the laws they must obey, at random.

use proptest::prelude::*;
use snell_math::{Normal3, Vector3};

use super::{any_normal_and_wo, config, normal_and_wo};
use crate::optics::{cos_transmitted, critical_angle, reflect, refract};

/// True where `t` is a unit vector behind the surface, in the plane of `wo` and the normal, and the sines are as Snell
/// says.
fn obeys_snell(wo: Vector3, normal: Normal3, eta: f64, t: Vector3) -> bool {
    let n = normal.as_vector();
    let (sine_i, sine_t) = (n.cross(wo), n.cross(t));
    n.dot(t) <= 0.0 && (t.length() - 1.0).abs() < 1e-15 * 4.0 && (sine_i * eta + sine_t).length() < 1e-14
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn reflection_mirrors((normal, wo) in any_normal_and_wo()) {
        let r = reflect(wo, normal);
        prop_assert!((r.length() - 1.0).abs() < 1e-15 * 4.0);
        prop_assert!((normal.dot(r) - normal.dot(wo)).abs() < 1e-14);
        prop_assert!((r + wo - normal.as_vector() * (2.0 * normal.dot(wo))).length() < 1e-14);
        prop_assert!((reflect(r, normal) - wo).length() < 1e-14, "twice is back");
    }

    #[test]
    fn refraction_obeys_snell((normal, wo) in any_normal_and_wo(), eta in 0.3..3.0f64) {
        let cos_i = normal.dot(wo);
        let root = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
        prop_assume!(root.abs() > 1e-9);
        match refract(wo, normal, eta) {
            None => prop_assert!(root < 0.0),
            Some(t) => {
                prop_assert!(root > 0.0 && obeys_snell(wo, normal, eta, t));
                prop_assert!((cos_transmitted(cos_i, eta).unwrap() + normal.dot(t)).abs() < 1e-9);
                // The twin: the ratio upside down.
                if (eta - 1.0).abs() > 1e-3 && cos_i < 0.999 {
                    let swapped = refract(wo, normal, 1.0 / eta);
                    prop_assert!(swapped.is_none_or(|other| !obeys_snell(wo, normal, eta, other)));
                }
            }
        }
    }

    #[test]
    fn light_goes_back_the_way_it_came((normal, wo) in any_normal_and_wo(), eta in 0.3..1.0f64) {
        let t = refract(wo, normal, eta).expect("into the denser medium always");
        let back = refract(t, -normal, 1.0 / eta).expect("the same way back");
        // A sine's rounding is that of the cosine times their ratio: towards grazing light the way back is that much less certain.
        let bound = 1e-14 + 2e-14 / normal.dot(wo);
        prop_assert!((back - wo).length() < bound, "{:e} {bound:e}", (back - wo).length());
    }

    #[test]
    fn equal_indices_bend_nothing((normal, wo) in any_normal_and_wo()) {
        prop_assert!((refract(wo, normal, 1.0).unwrap() + wo).length() < 1e-15 * 2.0);
    }
}

#[test]
fn grazing_light_keeps_its_digits() {
    // With equal indices the textbook's root, 1 − (1 − c²), would lose a cosine of 1e-9 altogether.
    let (normal, wo) = normal_and_wo([0.0, 1.0, 0.0], 1e-9, 0.0);
    assert_eq!(cos_transmitted(1e-9, 1.0), Some(1e-9));
    assert_eq!(refract(wo, normal, 1.0), Some(-wo));
}

#[test]
fn normal_incidence_goes_straight() {
    let up = Normal3::new(0.0, 1.0, 0.0);
    for eta in [0.1, 0.75, 1.0, 1.5, 10.0] {
        let t = refract(Vector3::Y, up, eta).unwrap();
        assert_eq!(t.to_array(), [0.0, -1.0, 0.0]);
    }
    assert_eq!(reflect(Vector3::Y, up), Vector3::Y);
}

#[test]
fn refraction_ends_at_the_critical_angle() {
    for eta_i in [1.000_292_6, 1.333, 1.5, 2.419] {
        let critical = critical_angle(eta_i, 1.0).unwrap();
        let at = |angle: f64| {
            let (normal, wo) = normal_and_wo([0.3, 1.0, -0.2], snell_math::portable::cos(angle), 1.0);
            refract(wo, normal, eta_i)
        };
        assert!(at(critical - 1e-9).is_some());
        assert!(at(critical + 1e-9).is_none());
    }
    assert_eq!(critical_angle(1.0, 1.0), None);
}
