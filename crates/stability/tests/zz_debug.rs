mod common;
use common::*;
use fladder_stability::*;
#[test]
fn dbg() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).unwrap();
    for (n, truth) in wing.truth().iter().enumerate() {
        let pk = roots(&truth["pk_roots"]);
        if pk.is_empty() {
            continue;
        }
        let schedule = speeds([number(&truth["U"])], wing.density());
        let t = std::time::Instant::now();
        let r = Sweep {
            structure: &wing,
            schedule: &schedule,
            table: &table,
            fit: &fit,
            smooth: None,
            method: Method::Pk,
            pk_form: PkForm::Complex,
        }
        .run(&())
        .unwrap()
        .methods
        .pk
        .unwrap();
        println!("speed {n} {:?} zeros {:?}", t.elapsed(), r.zero_roots);
        let t = std::time::Instant::now();
        let p2 = Sweep {
            structure: &wing,
            schedule: &schedule,
            table: &table,
            fit: &fit,
            smooth: None,
            method: Method::P2,
            pk_form: PkForm::Complex,
        }
        .run(&())
        .unwrap()
        .methods
        .p2
        .unwrap();
        println!("p2 {:?} {}", t.elapsed(), p2.branches.len());
        println!("file:");
        for p in &pk {
            print!(" {:.6}{:+.6}i", p.re, p.im);
        }
        println!("\nmine:");
        for b in &r.branches {
            print!(" {:.6}{:+.6}i", b.g[0], b.k[0]);
        }
        println!();
    }
}
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.split_whitespace().collect();
    (f[13].parse::<f64>().unwrap() + f[14].parse::<f64>().unwrap()) / 100.0
}
#[test]
fn timing() {
    let wing = Wing::read();
    let table = wing.table(&[0.0]);
    let fit = PiecewiseQuadratic::centred(&table, DEFAULT_DAMPING_LIMIT).unwrap();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .unwrap();
    for method in [Method::P2, Method::Pk] {
        let schedule = speeds(range(20.0, 75.0, 200), wing.density());
        let c = cpu();
        let t = std::time::Instant::now();
        let r = pool.install(|| {
            Sweep {
                structure: &wing,
                schedule: &schedule,
                table: &table,
                fit: &fit,
                smooth: None,
                method,
                pk_form: PkForm::Complex,
            }
            .run(&())
            .unwrap()
        });
        println!("{method:?} wall {:?} cpu {:.2}", t.elapsed(), cpu() - c);
        for r in [r.methods.p2, r.methods.pk].into_iter().flatten() {
            for f in &r.flutter {
                println!("{} {} {:?}", f.speed, f.branch, f.kind);
            }
            println!(
                "{:?}",
                r.unstable_at_start
                    .iter()
                    .map(|u| (u.branch.clone(), u.speed, u.g, u.k))
                    .collect::<Vec<_>>()
            );
            println!(
                "{:?}",
                r.branches
                    .iter()
                    .map(|b| (b.name.clone(), b.first, b.g.len()))
                    .collect::<Vec<_>>()
            );
        }
    }
}
