//! Our simulated device, asked by a client that nobody here wrote.

use cipdeck_tests::command::Service;
use cipdeck_tests::peers::cpppo_client;

#[tokio::test]
async fn cpppo_reads_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    // Several requests are written before the first answer is read.
    let tags = ["-S", "-a", &device.address, "@1/1/7", "@1/1/2", "@4/100/4", "@238/1/1", "@1/1/7"];
    let said = cpppo_client("get_attribute", &tags).await;
    let name: Vec<_> = [18].iter().chain(b"cipdeck demo drive").map(u8::to_string).collect();
    let name = format!("@0x0001/1/7 == [{}]", name.join(", "));
    assert_eq!(said.matches(&name).count(), 2, "{said}");
    assert!(said.contains("@0x00EE/1/1 == None"), "a class that is not there: {said}");
}

#[tokio::test]
async fn cpppo_finds_the_simulated_device() {
    let device = Service::simulate("127.0.0.1:0", &[]).await;
    for more in [&["--udp"][..], &[]] {
        let arguments = [&["--list-identity", "-a", &device.address], more].concat();
        let said = cpppo_client("client", &arguments).await;
        assert!(said.contains("cipdeck demo drive"), "{more:?}: {said}");
    }
}
