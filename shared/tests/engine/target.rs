//! A scripted target: reads what the engine has written, and answers it as the test says.

use cipdeck_shared::config::{BlockId, MsgCipGeneric, Profile};
use cipdeck_shared::engine::{LinkId, TargetState, TargetView};
use cipdeck_shared::wire::{
    AdditionalStatus, Command, ConnectedMessage, ConnectionId, Encapsulation, EncapsulationStatus,
    ForwardOpen, ForwardOpenReply, GeneralStatus, Header, ListIdentityItem, MessageRouterReply,
    MessageRouterRequest, SendRrData, ServiceCode, ShortString, SocketAddress, UnconnectedMessage,
};

use crate::owner::{Owner, encapsulation};

/// What the target picks for the first connection; the next one has the next number.
pub(crate) const FIRST_O_T: u32 = 0x4000_0001;

/// One frame that the engine has written.
#[derive(Clone, Debug)]
pub(crate) struct Sent {
    pub(crate) header: Header,
    /// Connection id and sequence count.
    pub(crate) address: Option<(ConnectionId, u16)>,
    pub(crate) request: Option<MessageRouterRequest>,
}

impl Sent {
    fn decode(frame: &[u8]) -> Self {
        let frame = Encapsulation::decode(frame).unwrap();
        let (address, bytes) = match frame.header.command {
            Command::SendRRData => {
                let data = SendRrData::decode(frame.data()).unwrap();
                (None, Some(data.unconnected().unwrap().data.to_vec()))
            }
            Command::SendUnitData => {
                let item = SendRrData::decode(frame.data()).unwrap().connected().unwrap();
                (Some((item.id, item.sequence)), Some(item.message.to_vec()))
            }
            _ => (None, None),
        };
        let request = bytes.map(|bytes| MessageRouterRequest::decode(&bytes).unwrap());
        Self { header: frame.header, address, request }
    }

    fn word(&self) -> &'static str {
        match (self.header.command, self.request.as_ref().map(MessageRouterRequest::service)) {
            (Command::RegisterSession, _) => "register",
            (Command::UnRegisterSession, _) => "unregister",
            (Command::ListIdentity, _) => "identity",
            (Command::SendUnitData, _) => "connected",
            (_, Some(ServiceCode::ForwardOpen)) => "open",
            (_, Some(ServiceCode::LargeForwardOpen)) => "large open",
            (_, Some(ServiceCode::ForwardClose)) => "close",
            (_, Some(ServiceCode::UnconnectedSend)) => "routed",
            _ => "unconnected",
        }
    }

    /// The Forward_Open in it.
    pub(crate) fn open(&self) -> ForwardOpen {
        let request = self.request.as_ref().unwrap();
        ForwardOpen::decode(request.service() == ServiceCode::LargeForwardOpen, request.data()).unwrap()
    }
}

/// What a target says about itself.
pub(crate) fn identity(vendor: u16, device_type: u16, name: &[u8]) -> ListIdentityItem {
    ListIdentityItem {
        protocol_version: 1,
        address: SocketAddress::v4([10, 0, 0, 1], 44_818),
        vendor,
        device_type,
        product_code: 1,
        major: 1,
        minor: 1,
        status: 0,
        serial: 1,
        name: ShortString::new(name).unwrap(),
        state: 3,
    }
}

impl Owner {
    /// A block with a class 3 connection to a target that is nothing special.
    pub(crate) fn put_connected(
        &mut self,
        block: BlockId,
        path: &str,
        change: impl FnOnce(&mut MsgCipGeneric),
    ) {
        self.put(block, path, |config| {
            config.profile = Profile::Generic;
            config.target_cfg.cip_conn_mode = 1;
            change(config);
        });
    }

    /// Everything that was written, in words.
    pub(crate) fn trace(&self) -> Vec<&'static str> {
        self.written.iter().map(|(_, frame)| Sent::decode(frame).word()).collect()
    }

    /// What was written since then, in words.
    pub(crate) fn trace_since(&self, frames: usize) -> Vec<&'static str> {
        self.trace().split_off(frames)
    }

    /// The last frame of this link.
    pub(crate) fn last(&self, link: LinkId) -> Sent {
        let frame = self.written.iter().rev().find(|(to, _)| *to == link);
        Sent::decode(&frame.expect("something was written").1)
    }

    /// The reply to the last frame of this link, in the envelope of its request.
    pub(crate) fn answer_frame(&self, link: LinkId, reply: &MessageRouterReply<'_>) -> Vec<u8> {
        let sent = self.last(link);
        let mut message = Vec::new();
        reply.encode(&mut message);
        let mut frame = Vec::new();
        match sent.address {
            Some((o_t, sequence)) => {
                let id = self.t_o_of(o_t);
                let message = ConnectedMessage::new(&message).unwrap();
                message.encode(&sent.header, id, sequence, &mut frame);
            }
            None => UnconnectedMessage::new(&message).unwrap().encode(&sent.header, 0, &mut frame),
        }
        frame
    }

    /// What the engine has picked for the other direction of a connection.
    pub(crate) fn t_o_of(&self, o_t: ConnectionId) -> ConnectionId {
        let nth = usize::try_from(o_t.0 - FIRST_O_T).unwrap();
        let opens = self.written.iter().map(|(_, frame)| Sent::decode(frame));
        opens.filter(|sent| sent.word().ends_with("open")).nth(nth).unwrap().open().t_o_id
    }

    /// Answers the last request on this link with success.
    pub(crate) fn succeed(&mut self, link: LinkId, data: &[u8]) {
        let service = self.last(link).request.expect("a request was written").service();
        let frame = self.answer_frame(link, &MessageRouterReply::success(service, data));
        self.input(link, &frame);
    }

    /// Answers the last request on this link with a refusal.
    pub(crate) fn refuse(&mut self, link: LinkId, status: u8, words: &[u16], data: &[u8]) {
        let service = self.last(link).request.expect("a request was written").service();
        self.refuse_as(link, service, (status, words), data);
    }

    /// The same, as the reply of any service.
    pub(crate) fn refuse_as(
        &mut self,
        link: LinkId,
        service: ServiceCode,
        (status, words): (u8, &[u16]),
        data: &[u8],
    ) {
        let words: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let additional = AdditionalStatus::new(&words).unwrap();
        let reply = MessageRouterReply { service, status: GeneralStatus(status), additional, data };
        let frame = self.answer_frame(link, &reply);
        self.input(link, &frame);
    }

    /// Answers the last frame on this link with an encapsulation status.
    pub(crate) fn answer_status(&mut self, link: LinkId, status: u32) {
        let header = self.last(link).header.reply(EncapsulationStatus(status));
        self.input(link, &encapsulation(header, &[]));
    }

    /// Accepts the Forward_Open that was written last; the id that requests carry is the number of the Forward_Open.
    /// Connections of an earlier socket, which are closed first, are not known any more.
    pub(crate) fn accept_open(&mut self, link: LinkId) {
        while self.trace().last() == Some(&"close") {
            let frames = self.written.len();
            self.refuse(link, 1, &[0x0107], &[]);
            assert!(self.written.len() > frames, "something follows");
        }
        let opens = self.trace().iter().filter(|word| word.ends_with("open")).count();
        let open = self.last(link).open();
        let reply = ForwardOpenReply {
            o_t_id: ConnectionId(FIRST_O_T + u32::try_from(opens).unwrap() - 1),
            t_o_id: open.t_o_id,
            triad: open.triad,
            o_t_api_us: open.o_t_rpi_us,
            t_o_api_us: open.t_o_rpi_us,
        };
        let mut data = Vec::new();
        reply.encode(&mut data);
        self.succeed(link, &data);
    }

    /// Says who it is.
    pub(crate) fn answer_identity(&mut self, link: LinkId, item: &ListIdentityItem) {
        let header = self.last_header(link, Command::ListIdentity);
        let mut data = Vec::new();
        item.encode_reply(&mut data);
        self.input(link, &encapsulation(header, &data));
    }

    /// TCP, RegisterSession and Forward_Open; returns the link.
    pub(crate) fn register_and_open(&mut self) -> LinkId {
        let link = self.register();
        self.accept_open(link);
        link
    }

    /// How the only target looks.
    pub(crate) fn target(&self) -> TargetView {
        self.engine.targets().next().expect("a target").1
    }

    /// Whether the only target is as said.
    pub(crate) fn target_is(&self, state: TargetState) -> bool {
        self.target().state == state
    }
}
